#include "depth_fusion/submaps/submap_collection.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "depth_fusion/common/error.h"
#include "map/view_volume.h"
#include "submaps/block_store.h"

namespace depth_fusion {
namespace {

// On the sensor's way, where a submap of another part was left: no way from there is short enough.
constexpr double kNeverSure_m = -std::numeric_limits<double>::infinity();

}  // namespace

SubmapCollection::SubmapCollection(BlockMap& map, const SubmapParameters& parameters)
    : map_(map),
      parameters_(parameters),
      layers_(layersOf(map.parameters())),
      edge_(groupEdge(map.parameters().block_size)),
      block_m_(static_cast<double>(map.parameters().voxel_size_m) * map.parameters().block_size),
      generation_(map.generation()),
      store_(std::make_unique<BlockStore>(parameters, layers_, map.parameters().block_size)) {
  validate(parameters_.table());
  begin(map_.window());
  map_.bringBackBy([this](std::vector<BlockIndex>& requested) { return bringBackRequested(requested); });
}

SubmapCollection::~SubmapCollection() { map_.bringBackBy(nullptr); }

void SubmapCollection::follow() {
  if (map_.generation() == generation_) return;
  generation_ = map_.generation();
  submaps_.clear();
  absent_.clear();
  ahead_.clear();
  leaving_.clear();
  sensor_W_.reset();
  way_m_ = length_m_ = 0.0;
  store_->clear();
  begin(map_.window());
}

void SubmapCollection::enter(const Pose& T_W_D, bool is_given) {
  follow();
  const Eigen::Vector3d p_W = T_W_D.translation();
  if (submaps_.size() == 1 && isEmpty()) submaps_.front().window = map_.window();
  if (sensor_W_) {
    const double step_m = (p_W - *sensor_W_).norm();
    length_m_ += step_m;
    if (!is_given) way_m_ += step_m;
  }
  sensor_W_ = p_W;
  const bool is_inside = submaps_[active_].window.contains(blockAt(p_W));
  const bool is_long = parameters_.max_length_m > 0.0f && length_m_ > parameters_.max_length_m;
  if (is_inside && !is_long) return;
  const std::optional<uint32_t> next = is_inside ? std::nullopt : submapAbout(p_W);
  next ? activate(*next) : begin(Window::centredOn(p_W, block_m_, map_.window().blocks_per_axis));
}

bool SubmapCollection::beginPart() {
  follow();
  if (isEmpty()) return true;
  std::vector<int> all;
  for (const auto& [group, slots] : slotsOutside({BlockIndex::Zero(), 0}))
    all.insert(all.end(), slots.begin(), slots.end());
  if (!evict(all)) return false;
  begin(map_.window());
  for (uint32_t i = 0; i < submaps_.size(); ++i) {
    if (i != active_) submaps_[i].left_at_m = kNeverSure_m;
  }
  leaving_.clear();
  sensor_W_.reset();
  listAbsent();
  return true;
}

void SubmapCollection::begin(const Window& window) {
  submaps_.push_back({window, 0.0, {}, 0});
  activate(static_cast<uint32_t>(submaps_.size() - 1));
}

void SubmapCollection::activate(uint32_t submap) {
  if (active_ < submaps_.size()) submaps_[active_].left_at_m = way_m_;
  active_ = submap;
  length_m_ = 0.0;
  listAbsent();
}

bool SubmapCollection::isSure(uint32_t submap) const {
  const double left_at_m = submaps_[submap].left_at_m;
  return submap == active_ ||
         (left_at_m != kNeverSure_m && static_cast<double>(parameters_.drift) * (way_m_ - left_at_m) <=
                                           static_cast<double>(parameters_.sure_m));
}

std::optional<uint32_t> SubmapCollection::submapAbout(const Eigen::Vector3d& p_W) const {
  const BlockIndex block = blockAt(p_W);
  std::optional<uint32_t> nearest;
  int least_blocks = 0;
  for (uint32_t i = 0; i < submaps_.size(); ++i) {
    const Window& window = submaps_[i].window;
    if (i == active_ || !isSure(i) || !window.contains(block)) continue;
    const BlockIndex from_middle = block - window.origin - BlockIndex::Constant(window.blocks_per_axis / 2);
    const int blocks = from_middle.cwiseAbs().maxCoeff();
    if (nearest && blocks >= least_blocks) continue;
    nearest = i;
    least_blocks = blocks;
  }
  return nearest;
}

void SubmapCollection::adopt(const MapDescription& description, std::vector<GroupSizes> stored,
                             std::unique_ptr<BlockStore> store, const Window& window) {
  map_.resetAt(window.origin);
  follow();
  submaps_.clear();
  store_ = std::move(store);
  for (size_t i = 0; i < stored.size(); ++i) {
    const SubmapDescription& submap = description.submaps[i];
    submaps_.push_back({submap.window, submap.left_at_m, std::move(stored[i]), submap.blocks});
  }
  active_ = description.active_submap;
  way_m_ = description.way_m;
  listAbsent();
  bringBackNear(description.last_pose.T_W_D.translation());
}

std::vector<SubmapDescription> SubmapCollection::submaps() const {
  std::vector<SubmapDescription> descriptions;
  for (uint32_t i = 0; i < submaps_.size(); ++i) {
    const size_t blocks = submaps_[i].stored_blocks + (i == active_ ? map_.slots().used() : 0);
    descriptions.push_back({i, Pose::Identity(), submaps_[i].window, blocks, submaps_[i].left_at_m});
  }
  return descriptions;
}

std::vector<SubmapExtent> SubmapCollection::extents() const {
  const std::set<uint32_t> in_database = store_->submapsInDatabase();
  std::vector<SubmapExtent> extents;
  for (uint32_t i = 0; i < submaps_.size(); ++i) {
    BlockBox box;
    for (const auto& [group, count] : submaps_[i].stored) {
      box.extend(cubeFrom(edge_ * group, edge_));
    }
    if (i == active_) {
      for (const BlockBox& of_slots : map_.slots().groupBoxes()) {
        if (!of_slots.isEmpty()) box.extend(of_slots);
      }
    }
    if (box.isEmpty()) continue;
    const SubmapState elsewhere = in_database.count(i) > 0 ? SubmapState::kInStore : SubmapState::kInMemory;
    extents.push_back({boxInW(box), i == active_ ? SubmapState::kActive : elsewhere});
  }
  return extents;
}

Eigen::AlignedBox3d SubmapCollection::windowBox() const {
  return boxInW(cubeFrom(map_.window().origin, map_.window().blocks_per_axis));
}

Eigen::AlignedBox3d SubmapCollection::boxInW(const BlockBox& blocks) const {
  return {block_m_ * blocks.min().cast<double>(),
          block_m_ * (blocks.max().array() + 1).matrix().cast<double>()};
}

std::vector<BlockIndex> SubmapCollection::storedGroups() const {
  BlockSet groups;
  for (const Submap& submap : submaps_) {
    for (const auto& [group, count] : submap.stored) groups.insert(group);
  }
  return {groups.begin(), groups.end()};
}

bool SubmapCollection::isInPool(const BlockBox& box) const {
  bool is_elsewhere = false;
  forEachIn(groupsAbout(box, edge_), [&](const BlockIndex& group) {
    for (const Submap& submap : submaps_) is_elsewhere = is_elsewhere || submap.stored.count(group) > 0;
  });
  return !is_elsewhere;
}

size_t SubmapCollection::blockCount() const {
  size_t blocks = map_.slots().used();
  if (map_.generation() != generation_)
    return blocks;  // it was emptied, and what is stored is of the one before
  for (const Submap& submap : submaps_) blocks += submap.stored_blocks;
  return blocks;
}

BlockIndex SubmapCollection::blockAt(const Eigen::Vector3d& p_W) const {
  return (p_W / block_m_).array().floor().cast<int>();
}

void SubmapCollection::setStored(uint32_t submap, const BlockIndex& group, size_t blocks) {
  Submap& changed = submaps_[submap];
  const auto before = changed.stored.find(group);
  if (before != changed.stored.end()) {
    changed.stored_blocks -= before->second;
    changed.stored.erase(before);
  }
  if (blocks > 0) changed.stored[group] = blocks;
  changed.stored_blocks += blocks;
}

StoreUsage SubmapCollection::usage() const { return store_->usage(); }

}  // namespace depth_fusion
