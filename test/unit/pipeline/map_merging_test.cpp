#include "depth_fusion/pipeline/map_merging.h"

#include <gtest/gtest.h>

#include "depth_fusion/pipeline/map_refinement.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "support/expect_error.h"
#include "support/loop_keyframes.h"
#include "support/temporary_folder.h"
#include "support/test_compute.h"
#include "tools/evaluation/mesh_error.h"

namespace depth_fusion {
namespace {

// Two sensors turn in the same room, the second one from another place, in a world of its own.
class MergedMap : public testing::Test {
 protected:
  MergedMap() { parameters_.map.voxel_size_m = 0.01f; }

  // A map of what is seen from these places of the scene.
  void save(const LoopScene& scene, const std::string& name, double from_rad, const Pose& T_W_scene) {
    MapRefinement map(compute(), parameters_);
    Keyframes keyframes;
    for (int i = 0; i < 8; ++i) {
      const double angle = from_rad + 0.2 * i;
      const Pose T_scene_D = standingAt(0.3 * std::cos(angle), 0.3 * std::sin(angle), angle);
      auto keyframe = std::make_shared<Keyframe>(
          scene.keyframe(T_scene_D, T_W_scene * T_scene_D, 0.1 * i, static_cast<uint64_t>(100.0 * angle)));
      map.fuse(*keyframe, keyframe->T_W_D);
      keyframes.push_back(std::move(keyframe));
    }
    MapSaver saver(folder_ / name);
    map.save(saver, keyframes.front()->features.camera, {1.0, keyframes.back()->T_W_D}, keyframes);
  }
  std::unique_ptr<Database> open(const std::string& name) {
    return openDatabase(folder_ / name, DatabaseAccess::kRead);
  }

  TemporaryFolder folder_;
  PipelineParameters parameters_;
};

TEST_F(MergedMap, IsOfOnePiece) {
  const LoopScene scene("large_room");
  Pose T_B_scene(Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.2, 0.1, 1.0).normalized()));
  T_B_scene.translation() = Eigen::Vector3d(3.0, -1.0, 0.4);
  save(scene, "a.map", 0.0, Pose::Identity());
  save(scene, "b.map", 0.6, T_B_scene);
  const auto a = open("a.map"), b = open("b.map");
  MapSaver saver(folder_ / "both.map");
  double last = 0.0;
  const MergedMaps merged = mergeMaps(compute(), parameters_, *a, *b, saver, [&](double done) {
    EXPECT_GT(done, last);
    last = done;
  });
  EXPECT_NEAR(last, 1.0, 1e-9);
  const Pose error = merged.overlap.T_A_B * T_B_scene;  // T_A_scene is the identity
  EXPECT_LT(error.translation().norm(), 0.005);
  EXPECT_LT(rotationAngle(error), 0.003);
  EXPECT_GE(merged.overlap.agreeing, 3u);

  const auto both = open("both.map");
  BlockMap map(compute(), parameters_.map);
  SubmapCollection submaps(map, parameters_.submaps);
  ReadMap read(*both, submaps);
  EXPECT_EQ(read.loaded().keyframes.size(), 16u);
  read.moveTo(submaps);
  TriangleMesh mesh;
  exportSurfaceMesh(compute(), map, mesh);
  EXPECT_LT(compareMesh(mesh, Pose::Identity(), scene.surface()).surface_m.mean, 0.01);
  EXPECT_GT(merged.saved.blocks, describeMap(*a).submaps.front().blocks);
}

TEST_F(MergedMap, IsRefusedWithoutAnOverlap) {
  const LoopScene room("large_room"), other("white_room");
  save(room, "a.map", 0.0, Pose::Identity());
  save(room, "c.map", 3.0, Pose::Identity());
  const auto a = open("a.map"), c = open("c.map");
  MapSaver saver(folder_ / "none.map");
  expectError([&] { mergeMaps(compute(), parameters_, *a, *c, saver); }, {"no overlap", "nothing is merged"});
  EXPECT_EQ(openStoredMap(folder_ / "none.map"), nullptr);
}

}  // namespace
}  // namespace depth_fusion
