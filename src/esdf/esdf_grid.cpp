#include "depth_fusion/esdf/esdf_grid.h"

#include <algorithm>
#include <array>

namespace depth_fusion {
namespace {

constexpr int kMask = EsdfGrid::kBlockCells - 1;
static_assert((EsdfGrid::kBlockCells & kMask) == 0, "blocks are found by bits");

BlockIndex blockOf(const Eigen::Vector3i& cell) {
  return cell.unaryExpr([](int i) { return (i - (i & kMask)) / EsdfGrid::kBlockCells; });
}

size_t numberOf(const Eigen::Vector3i& cell) {
  return static_cast<size_t>((cell.x() & kMask) +
                             EsdfGrid::kBlockCells *
                                 ((cell.y() & kMask) + EsdfGrid::kBlockCells * (cell.z() & kMask)));
}

// Finds cells, the faster the nearer they are to those before.
class Lookup {
 public:
  explicit Lookup(const EsdfGrid::Blocks& blocks) : blocks_(blocks), found_(blocks.end()) {}

  const EsdfGrid::Block* block(const Eigen::Vector3i& cell) {
    const BlockIndex index = blockOf(cell);
    if (!has_looked_ || index != index_) found_ = blocks_.find(index);
    has_looked_ = true;
    index_ = index;
    return found_ == blocks_.end() ? nullptr : &found_->second;
  }
  int16_t steps(const Eigen::Vector3i& cell) {
    const EsdfGrid::Block* of_cell = block(cell);
    return of_cell == nullptr ? EsdfGrid::kUnknownSteps : of_cell->steps[numberOf(cell)];
  }

 private:
  const EsdfGrid::Blocks& blocks_;
  EsdfGrid::Blocks::const_iterator found_;
  BlockIndex index_ = BlockIndex::Zero();
  bool has_looked_ = false;
};

// The slope between the known ones of a cell's two neighbours and itself along an axis, in steps a cell.
float slopeAt(Lookup& cells, const Eigen::Vector3i& cell, int axis) {
  const Eigen::Vector3i by = Eigen::Vector3i::Unit(axis);
  std::array<int, 3> steps{cells.steps(cell - by), cells.steps(cell), cells.steps(cell + by)};
  float width = 2.0f;
  for (const size_t side : {0u, 2u}) {
    if (steps[side] != EsdfGrid::kUnknownSteps) continue;
    steps[side] = steps[1];
    width -= 1.0f;
  }
  return width > 0.0f ? static_cast<float>(steps[2] - steps[0]) / width : 0.0f;
}

// Weighs the corners of a cube of cells by where in it the point is, 0 to 1 to each axis: the distance, and
// its slopes, in steps.
void interpolate(const std::array<int16_t, 8>& corners, const Eigen::Vector3f& in_cube, EsdfSample& sample) {
  sample.distance_m = 0.0f;
  sample.gradient.setZero();
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3f weight, slope;
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_far = (corner >> axis & 1) != 0;
      weight[axis] = is_far ? in_cube[axis] : 1.0f - in_cube[axis];
      slope[axis] = is_far ? 1.0f : -1.0f;
    }
    const float steps = corners[static_cast<size_t>(corner)];
    sample.distance_m += steps * weight.prod();
    sample.gradient +=
        steps * Eigen::Vector3f(slope.x() * weight.y() * weight.z(), weight.x() * slope.y() * weight.z(),
                                weight.x() * weight.y() * slope.z());
  }
}

EsdfSample sampleAt(Lookup& cells, const Eigen::Vector3d& in_cells) {
  EsdfSample sample;
  const Eigen::Vector3i cell = in_cells.array().floor().cast<int>();
  const int16_t own = cells.steps(cell);
  sample.is_known = own != EsdfGrid::kUnknownSteps;
  if (!sample.is_known) return sample;
  const Eigen::Vector3d from_middle = in_cells.array() - 0.5;
  const Eigen::Vector3i first = from_middle.array().floor().cast<int>();
  std::array<int16_t, 8> corners{};
  bool all_known = true;
  for (int corner = 0; corner < 8; ++corner) {
    int16_t& steps = corners[static_cast<size_t>(corner)];
    steps = cells.steps(first + Eigen::Vector3i(corner & 1, corner >> 1 & 1, corner >> 2));
    all_known = all_known && steps != EsdfGrid::kUnknownSteps;
  }
  if (all_known) {
    interpolate(corners, (from_middle - first.cast<double>()).cast<float>(), sample);
  } else {
    sample.distance_m = own;
    for (int axis = 0; axis < 3; ++axis) sample.gradient[axis] = slopeAt(cells, cell, axis);
  }
  return sample;
}

}  // namespace

CellState EsdfGrid::stateAt(const Eigen::Vector3i& cell) const {
  const auto found = blocks_.find(blockOf(cell));
  return found == blocks_.end() ? CellState::kUnknown : found->second.states[numberOf(cell)];
}

std::optional<float> EsdfGrid::distanceAt_m(const Eigen::Vector3i& cell) const {
  const int16_t steps = Lookup(blocks_).steps(cell);
  if (steps == kUnknownSteps) return std::nullopt;
  return stepSize_m() * steps;
}

std::vector<EsdfSample> EsdfGrid::distances(const std::vector<Eigen::Vector3d>& points_W) const {
  Lookup cells(blocks_);
  const float step_m = stepSize_m();
  std::vector<EsdfSample> samples;
  samples.reserve(points_W.size());
  for (const Eigen::Vector3d& p_W : points_W) {
    const bool is_in_reach = (p_W.array().abs() < 1e6 * cell_size_m_).all();
    samples.push_back(is_in_reach ? sampleAt(cells, p_W / cell_size_m_) : EsdfSample());
    samples.back().distance_m *= step_m;
    samples.back().gradient *= step_m / static_cast<float>(cell_size_m_);
  }
  return samples;
}

}  // namespace depth_fusion
