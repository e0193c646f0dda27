#include "map/slots_in_view.h"

#include "map/map_args.h"
#include "map/view_volume.h"

namespace depth_fusion {
namespace {

constexpr double kMargin_blocks = 0.5;  // kernels take blocks for spheres

}  // namespace

SlotsInView::SlotsInView(ComputeContext& compute, const BlockMap& map)
    : groups_(compute, (map.usage().capacity + SLOTS_PER_GROUP - 1) / SLOTS_PER_GROUP * sizeof(int),
              "the list of slots in view") {}

void SlotsInView::list(const BlockMap& map, const CameraIntrinsics& camera, const Pose& T_D_W,
                       double max_range_m) {
  const MapParameters& parameters = map.parameters();
  const double block_m = static_cast<double>(parameters.voxel_size_m) * parameters.block_size;
  const ViewVolume view(camera, T_D_W, max_range_m);
  listed_.clear();
  const std::vector<BlockBox>& boxes = map.slots().groupBoxes();
  for (size_t group = 0; group < boxes.size(); ++group) {
    if (boxes[group].isEmpty()) continue;
    const Eigen::Vector3d first = boxes[group].min().cast<double>();
    const Eigen::Vector3d beyond = (boxes[group].max().array() + 1).cast<double>();
    const Eigen::Vector3d centre = 0.5 * block_m * (first + beyond);
    const Eigen::Vector3d half_extent = block_m * (0.5 * (beyond - first).array() + kMargin_blocks);
    if (view.meets(centre, half_extent)) listed_.push_back(static_cast<int>(group));
  }
  groups_.writeAsync(listed_.data(), listed_.size() * sizeof(int));
}

size_t SlotsInView::slots() const { return listed_.size() * SLOTS_PER_GROUP; }

}  // namespace depth_fusion
