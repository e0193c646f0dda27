#include "apps/benchmark/loops.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <random>

#include "apps/benchmark/loop_costs.h"
#include "apps/benchmark/loop_inputs.h"
#include "common/io/text_file.h"
#include "depth_fusion/common/percentile.h"
#include "depth_fusion/loops/loop_closer.h"
#include "loops/view_surface.h"
#include "tools/evaluation/trajectory_error.h"

namespace depth_fusion {
namespace {

constexpr double kSeen = 0.3;  // of one view in the other, from which on a place is seen again

// Which keyframes truly see the same.
class TrueOverlap {
 public:
  explicit TrueOverlap(const LoopInput& input) : input_(input) {
    for (const KeyframePtr& keyframe : input.keyframes)
      surfaces_.emplace_back(keyframe->view, keyframe->features.depth_sensor);
  }

  bool seesTheSame(size_t older, size_t newer) const {
    constexpr double kFar_m = 6.0, kTurned_rad = 1.4, kSame_m = 0.1;
    constexpr size_t kStep = 11;
    const Pose T_old_new = input_.keyframes[older]->T_W_D.inverse() * input_.keyframes[newer]->T_W_D;
    if (T_old_new.translation().norm() > kFar_m || rotationAngle(T_old_new) > kTurned_rad) return false;
    size_t points = 0, same = 0;
    const std::vector<SurfacePoint>& samples = surfaces_[newer].points();
    for (size_t i = 0; i < samples.size(); i += kStep, ++points) {
      const Eigen::Vector3d point = T_old_new * samples[i].point;
      const SurfacePoint* seen = surfaces_[older].seenTowards(point);
      same += seen != nullptr && (seen->point - point).norm() < kSame_m;
    }
    return static_cast<double>(same) > kSeen * static_cast<double>(points);
  }

 private:
  const LoopInput& input_;
  std::vector<ViewSurface> surfaces_;
};

bool isFalse(const LoopInput& input, const LoopCandidate& loop, double& error_m, double& error_rad) {
  const Pose T_old_new =
      input.keyframes[loop.old_keyframe]->T_W_D.inverse() * input.keyframes[loop.new_keyframe]->T_W_D;
  const Pose error = T_old_new.inverse() * loop.T_old_new;
  error_m = error.translation().norm();
  error_rad = rotationAngle(error);
  return error_m > input.wrong_m || error_rad > input.wrong_rad;
}

class LoopsBenchmark {
 public:
  explicit LoopsBenchmark(const LoopsOptions& options) : options_(options) {
    std::filesystem::create_directories(options.output);
    csv_.open(options.output + "/loops.csv");
    csv_ << "input,seed,new,old,verdict,likeness,matches,inliers,overlap,rmse_m,rmse_sigmas,contradicted,"
            "sigma_m,"
            "way_m,drift_sigmas,error_m,error_rad,text\n";
  }

  void run() {
    forEachLoopInput(options_, [this](const LoopInput& input) {
      findAndVerify(input);
      for (int seed = 1; seed <= options_.seeds; ++seed) close(input, seed);
    });
    const std::string text = places_ + "\n" + closures_ + "\n" + measureLoopCosts(options_.parameters);
    writeText(options_.output + "/loops.md", text);
    std::cout << "\n" << text;
  }

 private:
  void write(const LoopInput& input, int seed, const LoopCandidate& loop) {
    double error_m = 0.0, error_rad = 0.0;
    isFalse(input, loop, error_m, error_rad);
    csv_ << input.name << ',' << seed << ',' << loop.new_keyframe << ',' << loop.old_keyframe << ','
         << nameOf(loop.verdict) << ',' << loop.likeness << ',' << loop.matches << ',' << loop.inliers << ','
         << loop.overlap << ',' << loop.rmse_m << ',' << loop.rmse_sigmas << ',' << loop.contradicted << ','
         << loop.sigma_m << ',' << loop.way_m << ',' << loop.drift_sigmas << ',' << error_m << ','
         << error_rad << ',' << std::quoted(loop.text()) << '\n';
  }

  // Each keyframe alone, without what is known of poses.
  void findAndVerify(const LoopInput& input) {
    const TrueOverlap overlap(input);
    LoopFinder finder(options_.parameters.index_features);
    const LoopVerifier verifier(options_.parameters);
    size_t again = 0, found = 0, verified = 0, fits = 0, wrong = 0;
    std::vector<double> find_ms, verify_ms;
    for (uint32_t number = 0; number < input.keyframes.size(); ++number) {
      const Keyframe& keyframe = *input.keyframes[number];
      const auto isOld = [&](uint32_t other) {
        return keyframe.way_m - input.keyframes[other]->way_m >= options_.parameters.min_way_m;
      };
      bool is_again = false, is_found = false, is_verified = false;
      for (uint32_t other = 0; other < number && !is_again; ++other)
        is_again = isOld(other) && overlap.seesTheSame(other, number);
      const auto count = static_cast<size_t>(options_.parameters.max_candidates);
      std::vector<AlikeKeyframe> alike;
      find_ms.push_back(millisecondsOf([&] { alike = finder.find(keyframe.features, isOld, count); }));
      for (const AlikeKeyframe& other : alike) {
        is_found |= overlap.seesTheSame(other.number, number);
        LoopCandidate loop;
        loop.old_keyframe = other.number;
        loop.new_keyframe = number;
        loop.likeness = other.likeness;
        bool does_fit = false;
        verify_ms.push_back(millisecondsOf(
            [&] { does_fit = verifier.verify(*input.keyframes[other.number], keyframe, loop); }));
        write(input, 0, loop);
        if (!does_fit) continue;
        ++fits;
        double error_m = 0.0, error_rad = 0.0;
        const bool is_wrong = isFalse(input, loop, error_m, error_rad);
        wrong += is_wrong;
        is_verified |= !is_wrong;
      }
      again += is_again;
      found += is_again && is_found;
      verified += is_again && is_verified;
      finder.add(number, keyframe.features);
    }
    const auto share = [&](size_t part) {
      return again > 0 ? static_cast<double>(part) / static_cast<double>(again) : 0.0;
    };
    char row[300];
    std::snprintf(row, sizeof(row),
                  "| %s | %zu | %zu | %.2f | %.2f | %zu of %zu | %.2f, %.2f | %.1f, %.1f |\n",
                  input.name.c_str(), input.keyframes.size(), again, share(found), share(verified), wrong,
                  fits, percentile(find_ms, 0.5), percentile(find_ms, 0.99), percentile(verify_ms, 0.5),
                  percentile(verify_ms, 0.99));
    places_ += row;
    std::cout << row << std::flush;
  }

  // As they come, from a tracker that drifts.
  void close(const LoopInput& input, int seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    LoopCloser closer(options_.parameters);
    size_t closed = 0, wrong = 0, undone = 0, keyframes_closed = 0;
    std::vector<double> solve_ms;
    Pose T_W_tracked = input.keyframes.front()->T_W_D;
    for (size_t i = 0; i < input.keyframes.size(); ++i) {
      Keyframe keyframe = *input.keyframes[i];
      std::optional<KeyframeMotion> motion;
      if (i > 0) {
        motion = KeyframeMotion{drifted(*input.keyframes[i - 1], keyframe, random), Matrix6d::Zero()};
        T_W_tracked = T_W_tracked * motion->T_previous_current;
      }
      keyframe.T_W_D = T_W_tracked;
      const LoopReport report = closer.add(std::make_shared<const Keyframe>(std::move(keyframe)), motion);
      if (report.poses_changed) solve_ms.push_back(report.solve_ms);
      bool has_closed = false;
      for (const LoopCandidate& loop : report.candidates) {
        double error_m = 0.0, error_rad = 0.0;
        const bool is_closed = loop.verdict == LoopVerdict::kClosed;
        has_closed |= is_closed;
        closed += is_closed;
        undone += loop.verdict == LoopVerdict::kUndone;
        wrong += is_closed && isFalse(input, loop, error_m, error_rad);
        write(input, seed, loop);
      }
      keyframes_closed += has_closed;
    }
    const Corrections corrections = closer.corrections();
    std::vector<PosePair> before, after;
    for (size_t i = 0; i < input.keyframes.size(); ++i) {
      const Keyframe& truth = *input.keyframes[i];
      before.push_back({truth.stamp_s, corrections.keyframes()[i].T_W_then, truth.T_W_D});
      after.push_back({truth.stamp_s, corrections.keyframes()[i].T_W_now, truth.T_W_D});
    }
    char row[300];
    std::snprintf(row, sizeof(row), "| %s | %d | %zu | %zu | %zu | %.1f | %.1f | %.1f |\n",
                  input.name.c_str(), seed, closed, wrong, undone, 1e3 * rms(before), 1e3 * rms(after),
                  solve_ms.empty() ? 0.0 : percentile(solve_ms, 0.99));
    closures_ += row;
    std::cout << row << std::flush;
  }

  Pose drifted(const Keyframe& last, const Keyframe& next, std::mt19937& random) const {
    const Pose motion = last.T_W_D.inverse() * next.T_W_D;
    const Matrix6d covariance = driftCovariance(motion, next.way_m - last.way_m, options_.parameters);
    const Matrix6d root = covariance.llt().matrixL();
    std::normal_distribution<double> normal;
    Vector6d noise;
    for (double& value : noise) value = options_.drift * normal(random);
    return orthonormalized(poseFromTwist(root * noise) * motion);
  }

  static double rms(const std::vector<PosePair>& pairs) {
    double squares = 0.0;
    for (const PosePair& pair : pairs)
      squares += (pair.T_W_estimate.translation() - pair.T_W_truth.translation()).squaredNorm();
    return std::sqrt(squares / static_cast<double>(pairs.size()));
  }

  const LoopsOptions& options_;
  std::ofstream csv_;
  std::string places_ =
      "| input | keyframes | see a place again | found | found and verified | false of those that fit | "
      "find, "
      "median and p99 [ms] | verify [ms] |\n|---|---|---|---|---|---|---|---|\n";
  std::string closures_ =
      "| input | seed | loops closed | false | undone | drift before, rms [mm] | after [mm] | solve, p99 "
      "[ms] |\n"
      "|---|---|---|---|---|---|---|---|\n";
};

}  // namespace

void addLoopsBenchmark(CLI::App& app, LoopsOptions& options) {
  CLI::App* command = app.add_subcommand(
      "loops",
      "finds, verifies and closes loops on recordings and simulated buildings with true poses; writes "
      "loops.md and loops.csv");
  command->add_option("-o,--output", options.output, "folder of the results")->capture_default_str();
  command->add_option("--data", options.data,
                      "folder of the recordings; $DEPTH_FUSION_DATA or ../shared/data unless said");
  command->add_option("--input", options.inputs, "only these inputs");
  command->add_option("--seeds", options.seeds, "of drift, for each input")->capture_default_str();
  command->add_option("--drift", options.drift, "times what the parameters say")->capture_default_str();
  command->add_option("--params", options.parameter_files, "YAML files with `loops: {name: value}`");
  command->callback([&options] {
    for (const std::string& file : options.parameter_files)
      loadParameterFile(withPrefix("loops", options.parameters.table()), file);
    LoopsBenchmark(options).run();
  });
}

}  // namespace depth_fusion
