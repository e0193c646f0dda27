#include "depth_fusion/pipeline/map_merging.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/compute/device_image.h"
#include "depth_fusion/icp_tracking/icp_tracker.h"
#include "depth_fusion/loops/loop_finder.h"
#include "depth_fusion/loops/loop_verifier.h"
#include "depth_fusion/pipeline/map_refinement.h"
#include "depth_fusion/pipeline/stored_map.h"

namespace depth_fusion {
namespace {

constexpr double kMostElsewhere = 0.34;  // of what fits, that may say something else

// A stored map, and what its keyframes see of it.
class OpenMap {
 public:
  OpenMap(ComputeContext& compute, PipelineParameters parameters, Database& database)
      : name_(database.name()),
        parameters_(adopted(std::move(parameters), database)),
        map_(compute, parameters_.map),
        submaps_(map_, parameters_.submaps) {
    ReadMap read(database, submaps_);
    loaded_ = read.loaded();
    read.moveTo(submaps_);
    mapper_ = std::make_unique<Mapper>(compute, map_, submaps_, parameters_, loaded_.description.camera);
  }

  const std::string& name() const { return name_; }
  const PipelineParameters& parameters() const { return parameters_; }
  const LoadedMap& loaded() const { return loaded_; }

  const ModelView& render(const Pose& T_W_D) {
    StageTimers timers;
    return mapper_->render(T_W_D, timers);
  }
  // The keyframe with its view of the map as it is now.
  Keyframe seen(const Keyframe& keyframe) {
    Keyframe seen = keyframe;
    const ModelView& view = render(keyframe.T_W_D);
    seen.view =
        KeyframeView(readImage(view.depth, view.camera), view.camera, parameters_.loops.view_width_px);
    if (!parameters_.map.color) return seen;
    std::vector<uchar> jpeg;
    cv::imencode(".jpg", mapper_->renderer().coloredPicture(), jpeg);
    seen.color = {{jpeg.begin(), jpeg.end()}, view.camera, Pose::Identity()};
    return seen;
  }

 private:
  static PipelineParameters adopted(PipelineParameters parameters, Database& database) {
    const MapDescription description = describeMap(database);
    adoptParameters(description, parameters);
    const auto& layers = description.layers;
    parameters.map.color = std::find(layers.begin(), layers.end(), "color") != layers.end();
    return parameters;
  }

  const std::string name_;
  PipelineParameters parameters_;
  BlockMap map_;
  SubmapCollection submaps_;
  LoadedMap loaded_;
  std::unique_ptr<Mapper> mapper_;
};

// A keyframe of the second map that fits the first one.
struct Fit {
  Pose T_B_D, T_A_B;
};

class OverlapSearch {
 public:
  OverlapSearch(ComputeContext& compute, OpenMap& first)
      : compute_(compute),
        first_(first),
        loops_(first.parameters().loops),
        verifier_(loops_),
        finder_(loops_.index_features),
        seen_(first.loaded().keyframes.size()) {
    for (uint32_t number = 0; number < seen_.size(); ++number)
      finder_.add(number, first.loaded().keyframes[number]->features);
  }

  // The keyframe's fit with the place that looks most like it of those that fit.
  std::optional<Fit> fit(const Keyframe& keyframe) {
    const auto any = [](uint32_t) { return true; };
    for (const AlikeKeyframe& alike :
         finder_.find(keyframe.features, any, static_cast<size_t>(loops_.max_candidates))) {
      const Keyframe& old_keyframe = seen(alike.number);
      LoopCandidate loop;
      if (!verifier_.verify(old_keyframe, keyframe, loop)) continue;
      return Fit{keyframe.T_W_D,
                 aligned(keyframe, old_keyframe.T_W_D * loop.T_old_new) * keyframe.T_W_D.inverse()};
    }
    return std::nullopt;
  }

 private:
  const Keyframe& seen(uint32_t number) {
    std::optional<Keyframe>& seen = seen_[number];
    if (!seen) seen = first_.seen(*first_.loaded().keyframes[number]);
    return *seen;
  }

  // Where the keyframe's view lies on the first map by ICP; as it was guessed, if that says nothing.
  Pose aligned(const Keyframe& keyframe, const Pose& T_A_D) {
    const RgbdFrame frame = frameOf(keyframe);
    if (tracker_ == nullptr || !sameCamera(frame.intrinsics, camera_)) {
      camera_ = frame.intrinsics;
      preprocessor_ = std::make_unique<DepthPreprocessor>(
          compute_, ofViews(first_.parameters().preprocessing), camera_, first_.parameters().depth_sensor);
      tracker_ = std::make_unique<IcpTracker>(compute_, first_.parameters().icp_tracking, camera_);
    }
    StageTimers timers;
    const TrackingResult result = tracker_->track(preprocessor_->process(frame), first_.render(T_A_D),
                                                  {T_A_D, std::nullopt, "overlap"}, timers);
    return result.status == TrackingStatus::kTracking ? result.T_W_D : T_A_D;
  }

  ComputeContext& compute_;
  OpenMap& first_;
  const LoopParameters loops_;
  const LoopVerifier verifier_;
  LoopFinder finder_;
  std::vector<std::optional<Keyframe>> seen_;  // of the first map, as far as they were needed
  CameraIntrinsics camera_;
  std::unique_ptr<DepthPreprocessor> preprocessor_;
  std::unique_ptr<IcpTracker> tracker_;
};

// How far the keyframe is apart by the two motions.
double apart_m(const Fit& fit, const Pose& T_A_B) {
  return ((fit.T_A_B * fit.T_B_D).translation() - (T_A_B * fit.T_B_D).translation()).norm();
}

bool agrees(const Fit& fit, const Pose& T_A_B, const LoopParameters& loops) {
  return apart_m(fit, T_A_B) <= static_cast<double>(loops.agreement_m) &&
         rotationAngle(fit.T_A_B.inverse() * T_A_B) <= static_cast<double>(loops.agreement_rad);
}

std::vector<Fit> agreeingWith(const Pose& T_A_B, const std::vector<Fit>& fits, const LoopParameters& loops) {
  std::vector<Fit> agreeing;
  for (const Fit& fit : fits) {
    if (agrees(fit, T_A_B, loops)) agreeing.push_back(fit);
  }
  return agreeing;
}

// The mean of the motions, about the middle of the keyframes.
Pose meanOf(const std::vector<Fit>& fits) {
  Pose mean = fits.front().T_A_B;
  constexpr int kIterations = 5;
  for (int i = 0; i < kIterations; ++i) {
    Vector6d twist = Vector6d::Zero();
    Eigen::Vector3d middle_B = Eigen::Vector3d::Zero();
    const double share = 1.0 / static_cast<double>(fits.size());
    for (const Fit& fit : fits) middle_B += share * fit.T_B_D.translation();
    const Pose about(Eigen::Translation3d(mean * middle_B));
    for (const Fit& fit : fits)
      twist += share * twistFromPose(about.inverse() * fit.T_A_B * mean.inverse() * about);
    mean = orthonormalized(about * poseFromTwist(twist) * about.inverse() * mean);
  }
  return mean;
}

MapOverlap overlapOf(const std::vector<Fit>& fits, const LoopParameters& loops) {
  MapOverlap overlap;
  overlap.fitting = fits.size();
  std::vector<Fit> best;
  for (const Fit& fit : fits) {
    std::vector<Fit> agreeing = agreeingWith(fit.T_A_B, fits, loops);
    if (agreeing.size() > best.size()) best = std::move(agreeing);
  }
  overlap.agreeing = best.size();
  if (best.empty()) return overlap;
  overlap.T_A_B = meanOf(best);
  double squares = 0.0;
  for (const Fit& fit : best) squares += std::pow(apart_m(fit, overlap.T_A_B), 2);
  overlap.spread_m = std::sqrt(squares / static_cast<double>(best.size()));
  return overlap;
}

void checkOverlap(const MapOverlap& overlap, const LoopParameters& loops, const OpenMap& first,
                  const OpenMap& second) {
  const std::string of_both = second.name() + " and " + first.name();
  check(overlap.agreeing >= static_cast<size_t>(loops.agreeing_loops),
        of_both + " show no overlap: of " + std::to_string(second.loaded().keyframes.size()) + " keyframes " +
            std::to_string(overlap.fitting) + " fit, and " + std::to_string(overlap.agreeing) +
            " agree on where, where loops/agreeing_loops asks for " + std::to_string(loops.agreeing_loops) +
            "; nothing is merged");
  const double elsewhere = 1.0 - static_cast<double>(overlap.agreeing) / static_cast<double>(overlap.fitting);
  check(elsewhere <= kMostElsewhere, of_both + " fit in several ways that cannot both be: of " +
                                         std::to_string(overlap.fitting) + " keyframes that fit, only " +
                                         std::to_string(overlap.agreeing) +
                                         " agree; places in them may look alike; nothing is merged");
}

Keyframes movedBy(const Pose& T_A_B, const Keyframes& keyframes) {
  Keyframes moved;
  for (const KeyframePtr& keyframe : keyframes) {
    auto copy = std::make_shared<Keyframe>(*keyframe);
    copy->T_W_D = orthonormalized(T_A_B * keyframe->T_W_D);
    moved.push_back(std::move(copy));
  }
  return moved;
}

}  // namespace

MergedMaps mergeMaps(ComputeContext& compute, const PipelineParameters& parameters, Database& first,
                     Database& second, MapSaver& saver, const std::function<void(double)>& progress) {
  const auto say = [&](double done) {
    if (progress) progress(done);
  };
  MergedMaps merged;
  OpenMap second_map(compute, parameters, second);
  const Keyframes& keyframes_B = second_map.loaded().keyframes;
  const double steps = 2.0 * static_cast<double>(std::max<size_t>(keyframes_B.size(), 1));
  double done = 0.0;
  Keyframes keyframes;
  PipelineParameters of_first;
  {
    OpenMap first_map(compute, parameters, first);
    OverlapSearch search(compute, first_map);
    std::vector<Fit> fits;
    for (const KeyframePtr& keyframe : keyframes_B) {
      if (const std::optional<Fit> fit = search.fit(second_map.seen(*keyframe))) fits.push_back(*fit);
      say(++done / steps);
    }
    of_first = first_map.parameters();
    merged.overlap = overlapOf(fits, of_first.loops);
    checkOverlap(merged.overlap, of_first.loops, first_map, second_map);
    keyframes = first_map.loaded().keyframes;
  }
  MapRefinement result(compute, of_first);
  ReadMap(first, result.submaps()).moveTo(result.submaps());
  const Pose& T_A_B = merged.overlap.T_A_B;
  for (const KeyframePtr& keyframe : keyframes_B) {
    result.fuse(second_map.seen(*keyframe), T_A_B * keyframe->T_W_D);
    say(++done / steps);
  }
  for (const KeyframePtr& moved : movedBy(T_A_B, keyframes_B)) keyframes.push_back(moved);
  StampedPose last_pose = second_map.loaded().description.last_pose;
  last_pose.T_W_D = orthonormalized(T_A_B * last_pose.T_W_D);
  merged.saved = result.save(saver, second_map.loaded().description.camera, last_pose, keyframes);
  return merged;
}

}  // namespace depth_fusion
