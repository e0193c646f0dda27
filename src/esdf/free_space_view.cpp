#include "esdf/free_space_view.h"

#include <algorithm>
#include <cmath>

#include "frames/sensor_args.h"
#include "map/view_volume.h"

namespace depth_fusion {
namespace {

constexpr int kDoubt = 2;         // a noisy surface hides what is just behind it more often than not
constexpr double kNear_m = 0.05;  // of what is nearer to the camera, no part of the image is asked for

std::vector<float> tilesOf(const cv::Mat& depth_m) {
  std::vector<float> tiles;
  for (int v = 0; v < depth_m.rows; v += DEPTH_TILE) {
    for (int u = 0; u < depth_m.cols; u += DEPTH_TILE) {
      const cv::Rect tile(u, v, std::min(DEPTH_TILE, depth_m.cols - u),
                          std::min(DEPTH_TILE, depth_m.rows - v));
      double farthest_m = 0.0;
      cv::minMaxLoc(depth_m(tile), nullptr, &farthest_m);
      tiles.push_back(static_cast<float>(farthest_m));
    }
  }
  return tiles;
}

int tilesAcross(int pixels) { return (pixels + DEPTH_TILE - 1) / DEPTH_TILE; }

// The first and the last tile of an axis that points beside the axis from `from_m` to `to_m` are seen in.
std::pair<int, int> tileRange(double from_m, double to_m, double nearest_m, double farthest_m, double f,
                              double c, int tiles) {
  const double first = f * from_m / (from_m < 0.0 ? nearest_m : farthest_m) + c;
  const double last = f * to_m / (to_m < 0.0 ? farthest_m : nearest_m) + c;
  const auto tile = [&](double pixel) {
    return static_cast<int>(std::floor(std::clamp(pixel / DEPTH_TILE, 0.0, tiles - 1.0)));
  };
  return {tile(first), tile(last)};
}

}  // namespace

FreeSpaceView::FreeSpaceView(const DepthFrame& frame, const Pose& T_W_D)
    : camera_(frame.levels[0].camera),
      T_D_W_(T_W_D.inverse()),
      sensor_(toArgs(frame.levels[0].sensor)),
      sight_(1),
      doubt_(kDoubt),
      tile_columns_(tilesAcross(camera_.width)),
      tile_rows_(tilesAcross(camera_.height)) {
  tiles_m_ =
      frame.max_tiles.read<float>(static_cast<size_t>(tile_columns_) * static_cast<size_t>(tile_rows_));
}

FreeSpaceView::FreeSpaceView(const cv::Mat& depth_m, const CameraIntrinsics& camera, const Pose& T_W_D)
    : camera_(camera),
      T_D_W_(T_W_D.inverse()),
      sensor_{},
      sight_(ESDF_FREE),
      doubt_(0),
      tiles_m_(tilesOf(depth_m)),
      tile_columns_(tilesAcross(camera.width)),
      tile_rows_(tilesAcross(camera.height)) {}

std::vector<BlockIndex> FreeSpaceView::blocks(double edge_m) const {
  std::vector<BlockIndex> blocks;
  const float farthest_m = *std::max_element(tiles_m_.begin(), tiles_m_.end());
  if (!(farthest_m > 0.0f)) return blocks;
  const ViewVolume volume(camera_, T_D_W_, farthest_m);
  const auto index = [&](const Eigen::Vector3d& p_W) {
    return BlockIndex((p_W / edge_m).array().floor().cast<int>());
  };
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * edge_m);
  forEachIn(BlockBox(index(volume.box().min()), index(volume.box().max())), [&](const BlockIndex& block) {
    const Eigen::Vector3d centre_W = edge_m * block.cast<double>() + half;
    if (volume.meets(centre_W, half) && isBefore(T_D_W_ * centre_W, half.norm())) blocks.push_back(block);
  });
  return blocks;
}

bool FreeSpaceView::isBefore(const Eigen::Vector3d& centre_D, double radius_m) const {
  const double nearest_m = centre_D.z() - radius_m;
  return nearest_m < kNear_m || nearest_m < farthest_m(centre_D, radius_m);
}

float FreeSpaceView::farthest_m(const Eigen::Vector3d& centre_D, double radius_m) const {
  const double near_m = centre_D.z() - radius_m, far_m = centre_D.z() + radius_m;
  const auto [left, right] = tileRange(centre_D.x() - radius_m, centre_D.x() + radius_m, near_m, far_m,
                                       camera_.fx, camera_.cx, tile_columns_);
  const auto [top, bottom] = tileRange(centre_D.y() - radius_m, centre_D.y() + radius_m, near_m, far_m,
                                       camera_.fy, camera_.cy, tile_rows_);
  float farthest_m = 0.0f;
  for (int row = top; row <= bottom; ++row) {
    for (int column = left; column <= right; ++column)
      farthest_m = std::max(farthest_m, tiles_m_[static_cast<size_t>(row * tile_columns_ + column)]);
  }
  return farthest_m;
}

}  // namespace depth_fusion
