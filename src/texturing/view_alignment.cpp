#include "texturing/view_alignment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "color_fusion/color_alignment.h"
#include "color_fusion/exposure.h"
#include "depth_fusion/common/percentile.h"
#include "texturing/mesh_in_view.h"
#include "texturing/surface_points.h"

namespace depth_fusion {
namespace {

constexpr float kAlignedMargin_px = 3.0f;
constexpr double kPointWeight = 16.0;  // of a colour that counts fully

struct MeanColor {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  int count = 0;

  Eigen::Array3d mean() const { return sum / count; }
};

Eigen::Vector3f pixelOf(const Eigen::Vector3f& p_W, const Pose& T_C_W, const CameraIntrinsics& camera) {
  return projected((T_C_W * p_W.cast<double>()).cast<float>(), camera);
}

class ViewAlignment {
 public:
  ViewAlignment(const TriangleMesh& mesh, std::vector<ChosenView>& views,
                const TexturingParameters& parameters)
      : parameters_(parameters),
        views_(views),
        points_(pointsOn(mesh, static_cast<size_t>(parameters.alignment_points))),
        seen_(views.size()) {
    for (const ChosenView& view : views) priors_C_W_.push_back(view.view.T_W_C.inverse());
    poses_C_W_ = priors_C_W_;
    inParallel([&](size_t i) { seen_[i] = seenBy(mesh, views_[i].view); });
    decode();
  }

  void round() {
    const std::vector<MeanColor> colors = meanColors();
    inParallel([&](size_t i) { fit(i, colors); });
    normaliseGains();
  }

  double misfit() {
    const std::vector<MeanColor> colors = meanColors();
    std::vector<double> sums(views_.size(), 0.0), counts(views_.size(), 0.0);
    inParallel([&](size_t i) {
      forEachSample(i, [&](uint32_t point, const Eigen::Array3d& color) {
        if (colors[point].count < 2) return;
        sums[i] += (color - colors[point].mean()).abs().mean();
        counts[i] += 1.0;
      });
    });
    const double count = std::accumulate(counts.begin(), counts.end(), 0.0);
    return count > 0.0 ? std::accumulate(sums.begin(), sums.end(), 0.0) / count : 0.0;
  }

  // Returns the median move.
  double apply() {
    std::vector<double> moves_m;
    for (size_t i = 0; i < views_.size(); ++i) {
      const Pose T_W_C = orthonormalized(poses_C_W_[i]).inverse();
      moves_m.push_back((T_W_C.translation() - views_[i].view.T_W_C.translation()).norm());
      views_[i].view.T_W_C = T_W_C;
    }
    return percentile(moves_m, 0.5);
  }

 private:
  template <class Action>
  void inParallel(const Action& action) {
    cv::parallel_for_({0, static_cast<int>(views_.size())}, [&](const cv::Range& range) {
      for (int i = range.start; i < range.end; ++i) action(static_cast<size_t>(i));
    });
  }

  // As many images as the memory for them holds; the others are decoded whenever they are needed.
  void decode() {
    constexpr size_t kBytes = size_t{256} << 20;
    size_t count = 0, bytes = 0;
    for (; count < views_.size(); ++count) {
      const CameraIntrinsics& camera = views_[count].view.camera;
      bytes += 3 * static_cast<size_t>(camera.width) * static_cast<size_t>(camera.height);
      if (bytes > kBytes) break;
    }
    decoded_.resize(count);
    inParallel([&](size_t i) {
      if (i < count) decoded_[i] = imageOf(views_[i].view);
    });
  }
  cv::Mat image(size_t i) const { return i < decoded_.size() ? decoded_[i] : imageOf(views_[i].view); }

  std::vector<uint32_t> seenBy(const TriangleMesh& mesh, const TexturingView& view) const {
    const MeshInView in_view(mesh, view, parameters_.hidden_ratio);
    const Pose T_C_W = view.T_W_C.inverse();
    const double least_cosine = std::cos(static_cast<double>(parameters_.max_incidence_rad));
    std::vector<uint32_t> seen;
    for (uint32_t i = 0; i < points_.size(); ++i) {
      const Eigen::Vector3d ray_W = view.T_W_C.translation() - points_[i].p_W.cast<double>();
      if (ray_W.normalized().dot(points_[i].normal_W.cast<double>()) < least_cosine) continue;
      const Eigen::Vector3f uvz = pixelOf(points_[i].p_W, T_C_W, view.camera);
      if (isInside(uvz, view.camera, kAlignedMargin_px) && in_view.sees(uvz) && !in_view.isAtOutline(uvz))
        seen.push_back(i);
    }
    return seen;
  }

  template <class Action>
  void forEachSample(size_t i, const Action& action) const {
    const ChosenView& chosen = views_[i];
    const cv::Mat image = this->image(i);
    for (const uint32_t point : seen_[i]) {
      const Eigen::Vector3f uvz = pixelOf(points_[point].p_W, poses_C_W_[i], chosen.view.camera);
      if (!isInside(uvz, chosen.view.camera, kAlignedMargin_px)) continue;
      action(point, chosen.gain * sampled(image, uvz.x(), uvz.y()).cast<double>());
    }
  }

  std::vector<MeanColor> meanColors() {
    std::vector<std::vector<std::pair<uint32_t, Eigen::Array3f>>> samples(views_.size());
    inParallel([&](size_t i) {
      samples[i].reserve(seen_[i].size());
      forEachSample(i, [&](uint32_t point, const Eigen::Array3d& color) {
        samples[i].emplace_back(point, color.cast<float>());
      });
    });
    std::vector<MeanColor> colors(points_.size());
    for (const auto& of_view : samples) {
      for (const auto& [point, color] : of_view) {
        colors[point].sum += color.cast<double>();
        ++colors[point].count;
      }
    }
    return colors;
  }

  void fit(size_t i, const std::vector<MeanColor>& colors) {
    std::vector<SurfaceColor> surface;
    for (const uint32_t point : seen_[i]) {
      if (colors[point].count > 1)
        surface.push_back({points_[point].p_W.cast<double>(), colors[point].mean(), kPointWeight});
    }
    ColorImage image{views_[i].view.camera, {}};
    cv::cvtColor(this->image(i), image.bgra, cv::COLOR_BGR2BGRA);
    views_[i].gain = exposureGain(surface, image, poses_C_W_[i]).value_or(views_[i].gain);
    poses_C_W_[i] = alignColor(surface, image, views_[i].gain, priors_C_W_[i], poses_C_W_[i]);
  }

  // The texture is as bright as the pictures are in the mean.
  void normaliseGains() {
    Eigen::Array3d logarithms = Eigen::Array3d::Zero();
    for (const ChosenView& view : views_) logarithms += view.gain.log();
    const Eigen::Array3d mean = (logarithms / static_cast<double>(views_.size())).exp();
    for (ChosenView& view : views_) view.gain /= mean;
  }

  const TexturingParameters& parameters_;
  std::vector<ChosenView>& views_;
  const std::vector<PointOnMesh> points_;
  std::vector<std::vector<uint32_t>> seen_;  // points, by each view
  std::vector<cv::Mat> decoded_;             // the first views' images
  std::vector<Pose> priors_C_W_, poses_C_W_;
};

}  // namespace

Alignment alignViews(const TriangleMesh& mesh, std::vector<ChosenView>& views,
                     const TexturingParameters& parameters, const std::function<void(double)>& progress) {
  ViewAlignment alignment(mesh, views, parameters);
  Alignment result;
  result.misfit_before = alignment.misfit();
  for (int round = 0; round < parameters.alignment_rounds; ++round) {
    progress(static_cast<double>(round) / parameters.alignment_rounds);
    alignment.round();
  }
  result.misfit_after = alignment.misfit();
  result.move_m = alignment.apply();
  return result;
}

}  // namespace depth_fusion
