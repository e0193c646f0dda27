#include "apps/benchmark/starts.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <random>

#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "tools/evaluation/trajectory_error.h"

namespace depth_fusion {
namespace {

constexpr double kWrong_rad = 3.0 * CV_PI / 180.0;
constexpr double kMaxGap_s = 0.05;
constexpr size_t kMostFrames = 120;  // of a start, at most
constexpr size_t kLostForGood = 15;  // lost frames at a start's end

struct Start {
  size_t first = 0, step = 1;
  bool texture = true;
};

struct PoseError {
  double m = 0.0, rad = 0.0;

  bool isWrong() const { return m > kWrong_m || rad > kWrong_rad; }
};

// How far the estimated motion from a to b is from the true one.
PoseError errorBetween(const PosePair& a, const PosePair& b) {
  const Pose difference = motionError(a, b);
  return {difference.translation().norm(), rotationAngle(difference)};
}

struct StartOutcome {
  size_t frames = 0, lost = 0, lost_at_end = 0;
  size_t wrong = 0;        // frames called tracked whose pose, by the first one's, is wrong
  size_t wrong_steps = 0;  // frames called tracked whose motion since the tracked one before is wrong
  PoseError largest, largest_step;
  double first_wrong_s = -1.0;

  bool isWrong() const { return wrong + wrong_steps > 0; }
  bool isLostForGood() const { return lost_at_end >= kLostForGood; }
};

// Notes what becomes of each frame of a start.
class StartJudge {
 public:
  StartJudge(const TrackingInput& input, std::string name, std::ofstream& csv)
      : input_(input), name_(std::move(name)), csv_(csv) {}

  void add(double stamp_s, const TrackingResult& tracking) {
    ++outcome_.frames;
    const bool lost = tracking.status == TrackingStatus::kLost;
    outcome_.lost += lost;
    outcome_.lost_at_end = lost ? outcome_.lost_at_end + 1 : 0;
    const std::optional<Pose> T_W_truth = poseAt(input_.truth, stamp_s, kMaxGap_s);
    PoseError error, step;
    if (!lost && T_W_truth) {
      const PosePair pair{stamp_s, tracking.T_W_D, *T_W_truth};
      const bool begins_map = tracking.prior == "start";  // or begins it anew, in a place that is not known
      if (begins_map || !first_) first_ = last_ = pair;
      error = errorBetween(*first_, pair);
      step = errorBetween(*last_, pair);
      last_ = pair;
      if (tracking.status == TrackingStatus::kTracking) note(stamp_s, error, step);
    }
    write(stamp_s, tracking, error, step);
  }
  const StartOutcome& outcome() const { return outcome_; }

 private:
  void note(double stamp_s, const PoseError& error, const PoseError& step) {
    outcome_.wrong += error.isWrong() && !input_.truth_is_estimate;
    outcome_.wrong_steps += step.isWrong();
    if (outcome_.first_wrong_s < 0.0 && outcome_.isWrong()) outcome_.first_wrong_s = stamp_s;
    outcome_.largest = {std::max(outcome_.largest.m, error.m), std::max(outcome_.largest.rad, error.rad)};
    outcome_.largest_step = {std::max(outcome_.largest_step.m, step.m),
                             std::max(outcome_.largest_step.rad, step.rad)};
  }
  void write(double stamp_s, const TrackingResult& tracking, const PoseError& error, const PoseError& step) {
    const char* status[] = {"tracking", "degenerate", "lost"};
    csv_ << std::quoted(name_) << ',' << std::to_string(stamp_s) << ','
         << status[static_cast<int>(tracking.status)] << ',' << tracking.guessed_directions << ','
         << tracking.prior << ',' << tracking.explained << ',' << tracking.match_quality << ','
         << tracking.inlier_fraction << ',' << tracking.rmse_m << ',' << tracking.prior_sigmas << ','
         << tracking.smallest_eigenvalue << ',' << error.m << ',' << error.rad << ',' << step.m << ','
         << step.rad << ',' << std::quoted(tracking.map_doubt) << '\n';
  }

  const TrackingInput& input_;
  const std::string name_;
  std::ofstream& csv_;
  std::optional<PosePair> first_, last_;
  StartOutcome outcome_;
};

std::string nameOf(const TrackingInput& input, const Start& start) {
  return input.name + " from frame " + std::to_string(start.first) + ", every " + std::to_string(start.step) +
         (start.texture ? "" : ", without texture");
}

StartOutcome trackFrom(ComputeContext& compute, const TrackingInput& input,
                       const std::vector<RgbdFrame>& frames, const Start& start, std::ofstream& csv) {
  PipelineParameters parameters = input.parameters;
  parameters.texture_odometry.enabled = start.texture;
  ReconstructionPipeline pipeline(compute, parameters, frames.front().intrinsics);
  StartJudge judge(input, nameOf(input, start), csv);
  for (size_t i = start.first; i < frames.size() && judge.outcome().frames < kMostFrames; i += start.step)
    judge.add(frames[i].stamp_s, pipeline.processFrame(frames[i]).tracking);
  return judge.outcome();
}

std::vector<Start> drawStarts(size_t count, size_t frames, std::mt19937& random) {
  std::vector<Start> starts;
  for (size_t i = 0; i < count; ++i) {
    const size_t step = 1 + random() % 6;
    starts.push_back({random() % (frames - std::min(frames - 1, 10 * step)), step, random() % 3 != 0});
  }
  return starts;
}

// Every second to sixth frame from each of the first ten and from one of fast motion on, with texture and
// without.
std::vector<Start> everyStart(size_t frames) {
  constexpr size_t kFastOne = 211;  // of tum_fr1_xyz
  std::vector<Start> starts;
  for (const size_t first : {0ul, 1ul, 2ul, 3ul, 4ul, 5ul, 6ul, 7ul, 8ul, 9ul, kFastOne}) {
    if (first >= frames) continue;
    for (size_t step = 2; step <= 6; ++step) {
      for (const bool texture : {true, false}) starts.push_back({first, step, texture});
    }
  }
  return starts;
}

std::string faultLine(const std::string& what, const StartOutcome& outcome) {
  char line[300];
  std::snprintf(line, sizeof(line),
                "%s: %zu of %zu frames wrong (%.0f mm, %.1f deg), %zu wrong steps (%.0f mm, %.1f deg), first "
                "at %.3f s; %zu lost, %zu at the end\n",
                what.c_str(), outcome.wrong, outcome.frames, 1e3 * outcome.largest.m,
                outcome.largest.rad * 180.0 / CV_PI, outcome.wrong_steps, 1e3 * outcome.largest_step.m,
                outcome.largest_step.rad * 180.0 / CV_PI, outcome.first_wrong_s, outcome.lost,
                outcome.lost_at_end);
  return line;
}

}  // namespace

void runStarts(const TrackingBenchmark& options) {
  std::filesystem::create_directories(options.output);
  std::ofstream csv(options.output + "/starts.csv");
  csv << "start,stamp_s,status,guessed,prior,explained,match_quality,inlier_fraction,rmse_m,prior_sigmas,"
         "smallest_eigenvalue,error_m,error_rad,step_m,step_rad,map_doubt\n";
  ComputeContext compute(options.device);
  std::mt19937 random(options.seed);
  const std::vector<TrackingInput> inputs = startInputs(options);
  std::string table =
      "| input | starts | frames | lost | starts lost for good | starts with a wrong frame |\n"
      "|---|---|---|---|---|---|\n";
  std::string faults;
  for (size_t i = 0; i < inputs.size(); ++i) {
    const std::vector<RgbdFrame> frames = framesOf(inputs[i]);
    const size_t count = options.starts * (i + 1) / inputs.size() - options.starts * i / inputs.size();
    const std::vector<Start> starts =
        options.strides ? everyStart(frames.size()) : drawStarts(count, frames.size(), random);
    StartOutcome sum;
    size_t lost_for_good = 0, wrong = 0;
    for (const Start& start : starts) {
      const StartOutcome outcome = trackFrom(compute, inputs[i], frames, start, csv);
      sum.frames += outcome.frames;
      sum.lost += outcome.lost;
      lost_for_good += outcome.isLostForGood();
      wrong += outcome.isWrong();
      if (!outcome.isWrong() && !outcome.isLostForGood()) continue;
      faults += "- " + faultLine(nameOf(inputs[i], start), outcome);
      std::cout << faultLine(nameOf(inputs[i], start), outcome) << std::flush;
    }
    char row[300];
    std::snprintf(row, sizeof(row), "| %s | %zu | %zu | %zu | %zu | %zu |\n", inputs[i].name.c_str(),
                  starts.size(), sum.frames, sum.lost, lost_for_good, wrong);
    std::cout << row << std::flush;
    table += row;
  }
  writeText(options.output + "/starts.md", table + "\n" + faults);
}

}  // namespace depth_fusion
