#include "tools/calibration/depth_calibration.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "depth_fusion/common/error.h"
#include "depth_fusion/preprocessing/depth_correction.h"
#include "tools/calibration/calibration_parts.h"
#include "tools/calibration/frame_pair.h"
#include "tools/calibration/plane_patches.h"

namespace depth_fusion {
namespace {

// This is known of a sensor beforehand: neighbouring offsets differ by about 1 % of the depth at 1 m, and as
// its maker has calibrated it, their mean is 0 to half a percent. Without the latter, small errors of any
// kind would turn into a large common offset, which real scenes tell little of.
constexpr double kNeighbourSigma_per_m = 0.01;
constexpr double kMeanSigma_per_m = 0.005;
constexpr double kReadoutSigma_s = 0.03;
// An offset, and the readout, counts as determined if its standard deviation is below these.
constexpr double kObservedOffset_per_m = 0.008;
constexpr double kObservedReadout_s = 0.008;

// Residuals of neighbouring pixels, and of frames with the same noise pattern, depend on each other: so many
// count as one.
constexpr double kCorrelatedResiduals = 200.0;
// Uncertainties are taken from how much so many parts of the frames contradict each other.
constexpr int kSegments = 10;

// The frames of a pair are so many frames apart.
constexpr int kPairGaps[] = {1, 2, 4, 8, 16};
// Each pass counts residuals up to so many standard deviations.
constexpr double kCutoffs_sigmas[] = {4.0, 3.0, 3.0};

ParameterMatrix priorHessian() {
  ParameterVector mean = ParameterVector::Constant(1.0 / (kReadoutIndex * kMeanSigma_per_m));
  mean[kReadoutIndex] = 0.0;
  ParameterMatrix hessian = mean * mean.transpose();
  hessian(kReadoutIndex, kReadoutIndex) = 1.0 / (kReadoutSigma_s * kReadoutSigma_s);
  const auto bind = [&](int a, int b) {
    const double weight = 1.0 / (kNeighbourSigma_per_m * kNeighbourSigma_per_m);
    hessian(a, a) += weight;
    hessian(b, b) += weight;
    hessian(a, b) -= weight;
    hessian(b, a) -= weight;
  };
  for (int row = 0; row < kGridRows; ++row) {
    for (int column = 0; column < kGridColumns; ++column) {
      const int index = row * kGridColumns + column;
      if (column + 1 < kGridColumns) bind(index, index + 1);
      if (row + 1 < kGridRows) bind(index, index + kGridColumns);
    }
  }
  return hessian;
}

cv::Mat gridOf(const ParameterVector& parameters) {
  cv::Mat grid(kGridRows, kGridColumns, CV_32FC1);
  for (int i = 0; i < kReadoutIndex; ++i) grid.ptr<float>()[i] = static_cast<float>(parameters[i]);
  return grid;
}

class Calibrator {
 public:
  Calibrator(ComputeContext& compute, const PipelineParameters& parameters,
             const std::vector<CalibrationFrame>& frames)
      : frames_(frames),
        parameters_(parameters.preprocessing),
        sensor_(parameters.depth_sensor),
        preprocessor_(compute, parameters.preprocessing, frames.front().frame.intrinsics,
                      parameters.depth_sensor),
        prior_(priorHessian()) {
    defaults_.setZero();
    defaults_[kReadoutIndex] = parameters.preprocessing.readout_s;
    estimate_ = defaults_;
  }

  DepthCalibration run() {
    DepthCalibration result;
    for (const double cutoff_sigmas : kCutoffs_sigmas) {
      result.after = pass(cutoff_sigmas);
      if (result.before.map_per_m.empty()) result.before = result.after;
    }
    result.pairs = static_cast<int>(T_B_A_.size());
    result.planes = planes_;
    describe(result);
    return result;
  }

 private:
  // Builds the systems with the estimate so far, and improves it.
  DepthResiduals pass(double cutoff_sigmas) {
    ResidualMap map;
    segments_.assign(kSegments, NormalEquations());
    applyEstimate();
    makeViews();
    addPlanes(cutoff_sigmas, map);
    addPairs(cutoff_sigmas);
    views_.clear();
    solve();
    return map.residuals();
  }

  void applyEstimate() {
    parameters_.depth_offsets_per_m = depthOffsetsText(gridOf(estimate_));
    parameters_.readout_s = static_cast<float>(std::max(estimate_[kReadoutIndex], 0.0));
    preprocessor_.setParameters(parameters_, sensor_);
  }

  void makeViews() {
    for (const CalibrationFrame& frame : frames_) views_.emplace_back(preprocessor_, frame);
  }

  NormalEquations& segmentOf(size_t frame) { return segments_[frame * kSegments / frames_.size()]; }

  void addPlanes(double cutoff_sigmas, ResidualMap& map) {
    planes_ = 0;
    for (size_t i = 0; i < views_.size(); ++i) {
      const PlanesResult result = fitPlanes(views_[i], i, cutoff_sigmas, map);
      planes_ += result.planes;
      segmentOf(i).add(result.equations);
    }
  }

  void addPairs(double cutoff_sigmas) {
    std::map<std::pair<size_t, size_t>, Pose> refined;
    for (size_t a = 0; a < views_.size(); ++a) {
      for (const size_t gap : kPairGaps) {
        const size_t b = a + gap;
        if (b >= views_.size() || (gap > 1 && b % 2 == 1)) continue;
        const auto known = T_B_A_.find({a, b});
        const Pose start =
            known != T_B_A_.end() ? known->second : frames_[b].T_W_D.inverse() * frames_[a].T_W_D;
        const auto result = matchPair(views_[a], views_[b], start, cutoff_sigmas);
        if (!result) continue;
        refined[{a, b}] = result->T_B_A;
        segmentOf(a).add(result->equations);
      }
    }
    T_B_A_ = std::move(refined);
  }

  void solve() {
    for (NormalEquations& segment : segments_) {
      segment.hessian /= kCorrelatedResiduals;
      segment.gradient /= kCorrelatedResiduals;
    }
    const SegmentedSystem system(segments_, prior_, estimate_, defaults_);
    parts_ = system.verdicts();
    sigmas_ = system.sigmas();
    if (sigmas_[kReadoutIndex] >= kObservedReadout_s)
      parts_[static_cast<size_t>(CalibrationPart::kReadout)].applied = false;
    estimate_ = system.solution(parts_);
  }

  void describe(DepthCalibration& result) const {
    result.offsets_per_m = gridOf(estimate_);
    result.sigmas_per_m = gridOf(sigmas_);
    result.observed_offsets =
        static_cast<int>((sigmas_.head<kReadoutIndex>().array() < kObservedOffset_per_m).count());
    result.readout_s = {estimate_[kReadoutIndex], sigmas_[kReadoutIndex]};
    result.parts = parts_;
    result.readout_observed = sigmas_[kReadoutIndex] < kObservedReadout_s;
  }

  const std::vector<CalibrationFrame>& frames_;
  PreprocessingParameters parameters_;
  DepthSensorParameters sensor_;
  DepthPreprocessor preprocessor_;
  ParameterMatrix prior_;
  ParameterVector defaults_, estimate_;
  ParameterVector sigmas_;
  std::vector<PartVerdict> parts_;
  std::vector<NormalEquations> segments_;
  std::vector<CalibrationView> views_;
  std::map<std::pair<size_t, size_t>, Pose> T_B_A_;  // of the frames' numbers
  int planes_ = 0;
};

}  // namespace

DepthCalibration calibrateDepth(ComputeContext& compute, const PipelineParameters& parameters,
                                const std::vector<CalibrationFrame>& frames) {
  check(frames.size() >= kSegments,
        "only " + std::to_string(frames.size()) +
            " frames differ enough to calibrate from; move the sensor about: half a metre "
            "to and fro, left and right, up and down");
  const DepthCalibration result = Calibrator(compute, parameters, frames).run();
  check(result.pairs + result.planes > 0,
        "no plane is large enough, and no two frames see the same surface; show the sensor walls, floors and "
        "tables "
        "within its range");
  check(result.observed_offsets > 0,
        "the depth offsets are not determined by what the frames see; show the sensor large planes at many "
        "distances");
  return result;
}

}  // namespace depth_fusion
