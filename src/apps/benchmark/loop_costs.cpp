#include "apps/benchmark/loop_costs.h"

#include <algorithm>
#include <random>
#include <vector>

#include "depth_fusion/common/percentile.h"
#include "depth_fusion/loops/loop_finder.h"
#include "depth_fusion/loops/pose_graph.h"
#include "loops/graph_way.h"

namespace depth_fusion {
namespace {

// As skewed as those of real images are: a few bits are mostly set.
FrameFeatures madeUpFeatures(std::mt19937_64& random, size_t count) {
  FrameFeatures features;
  features.features.resize(count);
  for (Feature& feature : features.features) {
    for (uint64_t& bits : feature.descriptor) bits = random() | (random() & random());
  }
  return features;
}

FrameFeatures seenAgain(FrameFeatures features, std::mt19937_64& random) {
  for (Feature& feature : features.features) {
    const bool is_there = random() % 10 < 4;
    for (uint64_t& bits : feature.descriptor)
      bits = is_there ? bits ^ (random() & random() & random()) : random();
  }
  return features;
}

std::string measureFinder(uint32_t keyframes, const LoopParameters& parameters) {
  std::mt19937_64 random(1);
  LoopFinder finder(parameters.index_features);
  constexpr uint32_t kQueries = 100;
  std::vector<FrameFeatures> places;
  for (uint32_t i = 0; i < keyframes; ++i) {
    FrameFeatures features = madeUpFeatures(random, static_cast<size_t>(parameters.index_features));
    finder.add(i, features);
    if (places.size() < kQueries) places.push_back(std::move(features));
  }
  size_t found = 0;
  std::vector<double> times_ms;
  for (uint32_t i = 0; i < kQueries; ++i) {
    const FrameFeatures features = seenAgain(places[i], random);
    std::vector<AlikeKeyframe> alike;
    times_ms.push_back(millisecondsOf([&] {
      alike = finder.find(
          features, [](uint32_t) { return true; }, 4);
    }));
    found += !alike.empty() && alike.front().number == i;
  }
  char row[200];
  std::snprintf(row, sizeof(row), "| %u | %.2f | %.2f | %.1f | %.2f |\n", keyframes,
                percentile(times_ms, 0.5), percentile(times_ms, 0.99),
                static_cast<double>(finder.bytes()) / (1 << 20), static_cast<double>(found) / kQueries);
  return row;
}

// Laps of 100 keyframes, tracked with drift.
class Laps {
 public:
  Laps(uint32_t nodes, const LoopParameters& parameters) : graph(parameters) {
    std::normal_distribution<double> normal;
    const double turn_rad = 2.0 * 3.141592653589793 / 100.0;
    const Pose motion = poseFromTwist((Vector6d() << 0.0, turn_rad, 0.0, 0.0, 0.0, kStep_m).finished());
    const Matrix6d root = driftCovariance(motion, kStep_m, parameters).llt().matrixL();
    graph.addNode(Pose::Identity());
    truth_.push_back(Pose::Identity());
    for (uint32_t i = 1; i < nodes; ++i) {
      Vector6d noise;
      for (double& value : noise) value = normal(random_);
      const Pose measured = orthonormalized(poseFromTwist(root * noise) * motion);
      truth_.push_back(orthonormalized(truth_.back() * motion));
      graph.addNode(graph.pose(i - 1) * measured);
      graph.addWay(i - 1, i, measured, kStep_m);
    }
  }

  // A closure of three loops between a lap and the one before.
  void addClosure() {
    const Matrix6d covariance = Vector6d(Vector6d::Constant(0.02)).cwiseAbs2().asDiagonal();
    const auto nodes = static_cast<uint32_t>(graph.size());
    const uint32_t first = 100 + static_cast<uint32_t>(random_() % (nodes - 102));
    for (uint32_t newer = first; newer < first + 3; ++newer) {
      const uint32_t older = newer - 100;
      graph.addLoop(older, newer, truth_[older].inverse() * truth_[newer], covariance, closures_);
    }
    ++closures_;
  }

  PoseGraph graph;

 private:
  static constexpr double kStep_m = 0.3;
  std::mt19937 random_{2};
  std::vector<Pose> truth_;
  uint32_t closures_ = 0;
};

std::string measureGraph(uint32_t nodes, const LoopParameters& parameters) {
  constexpr int kClosures = 33;
  Laps laps(nodes, parameters);
  std::vector<double> solve_ms, ways_ms;
  size_t undone = 0;
  for (int i = 0; i < kClosures; ++i) {
    laps.addClosure();
    solve_ms.push_back(millisecondsOf([&] { undone += laps.graph.solve().undone.size(); }));
    ways_ms.push_back(millisecondsOf([&] { GraphWays(laps.graph, nodes - 1).relationFrom(0); }));
  }
  char row[200];
  std::snprintf(row, sizeof(row), "| %u | %d | %.1f | %.1f | %zu | %.2f | %.1f |\n", nodes, 3 * kClosures,
                percentile(solve_ms, 0.5), percentile(solve_ms, 1.0), undone, percentile(ways_ms, 0.5),
                static_cast<double>(laps.graph.bytes()) / (1 << 20));
  return row;
}

}  // namespace

std::string measureLoopCosts(const LoopParameters& parameters) {
  std::string text =
      "| keyframes in the index | find, median [ms] | p99 [ms] | index [MiB] | found first "
      "|\n|---|---|---|---|---|\n";
  for (const uint32_t keyframes : {1000u, 5000u}) text += measureFinder(keyframes, parameters);
  text +=
      "\n| nodes | loops in the end | solve after each closure, median [ms] | largest [ms] | undone | ways "
      "[ms] | "
      "graph [MiB] |\n|---|---|---|---|---|---|---|\n";
  for (const uint32_t nodes : {1000u, 5000u}) text += measureGraph(nodes, parameters);
  return text;
}

}  // namespace depth_fusion
