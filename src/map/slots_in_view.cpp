#include "map/slots_in_view.h"

#include <algorithm>
#include <array>

#include "map/map_args.h"

namespace depth_fusion {
namespace {

constexpr double kMargin_blocks = 0.5;  // kernels take blocks for spheres

// A half space of W: points p with normal . p + offset >= 0.
struct HalfSpace {
  Eigen::Vector3d normal;
  double offset;

  bool meets(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_extent) const {
    return normal.dot(centre) + normal.cwiseAbs().dot(half_extent) + offset >= 0.0;
  }
};

// What the image shows up to a depth, and a pixel beside.
std::array<HalfSpace, 6> viewOf(const CameraIntrinsics& camera, const Pose& T_D_W, double max_range_m) {
  const auto inW = [&](const Eigen::Vector3d& normal_D, double offset) {
    return HalfSpace{T_D_W.linear().transpose() * normal_D, normal_D.dot(T_D_W.translation()) + offset};
  };
  return {inW({0.0, 0.0, 1.0}, 0.0),
          inW({0.0, 0.0, -1.0}, max_range_m),
          inW({camera.fx, 0.0, camera.cx + 1.0}, 0.0),
          inW({-camera.fx, 0.0, camera.width - camera.cx}, 0.0),
          inW({0.0, camera.fy, camera.cy + 1.0}, 0.0),
          inW({0.0, -camera.fy, camera.height - camera.cy}, 0.0)};
}

}  // namespace

SlotsInView::SlotsInView(ComputeContext& compute, const BlockMap& map)
    : groups_(compute, (map.usage().capacity + SLOTS_PER_GROUP - 1) / SLOTS_PER_GROUP * sizeof(int),
              "the list of slots in view") {}

void SlotsInView::list(const BlockMap& map, const CameraIntrinsics& camera, const Pose& T_D_W,
                       double max_range_m) {
  const MapParameters& parameters = map.parameters();
  const double block_m = static_cast<double>(parameters.voxel_size_m) * parameters.block_size;
  const std::array<HalfSpace, 6> view = viewOf(camera, T_D_W, max_range_m);
  listed_.clear();
  const std::vector<BlockBox>& boxes = map.slots().groupBoxes();
  for (size_t group = 0; group < boxes.size(); ++group) {
    if (boxes[group].isEmpty()) continue;
    const Eigen::Vector3d first = boxes[group].min().cast<double>();
    const Eigen::Vector3d beyond = (boxes[group].max().array() + 1).cast<double>();
    const Eigen::Vector3d centre = 0.5 * block_m * (first + beyond);
    const Eigen::Vector3d half_extent = block_m * (0.5 * (beyond - first).array() + kMargin_blocks);
    const auto meets = [&](const HalfSpace& side) { return side.meets(centre, half_extent); };
    if (std::all_of(view.begin(), view.end(), meets)) listed_.push_back(static_cast<int>(group));
  }
  groups_.writeAsync(listed_.data(), listed_.size() * sizeof(int));
}

size_t SlotsInView::slots() const { return listed_.size() * SLOTS_PER_GROUP; }

}  // namespace depth_fusion
