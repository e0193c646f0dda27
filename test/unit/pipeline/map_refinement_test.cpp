#include "depth_fusion/pipeline/map_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "support/loop_keyframes.h"
#include "support/temporary_folder.h"
#include "support/test_compute.h"
#include "tools/evaluation/mesh_error.h"

namespace depth_fusion {
namespace {

// A sensor sees a part of a room in passing, and once more after its poses have drifted off by 15 cm.
class MapRefined : public testing::Test {
 protected:
  MapRefined() {
    for (int i = 0; i < 8; ++i) {
      const Pose T_scene_D = standingAt(0.1 * (i % 4), 0.05 * i, 0.1 * (i % 4));
      Pose T_W_tracked = T_scene_D;
      if (i >= 4) T_W_tracked.translation().x() += 0.15;
      auto keyframe = std::make_shared<Keyframe>(
          scene_.keyframe(T_scene_D, T_W_tracked, 0.1 * i, static_cast<uint64_t>(i)));
      const RgbdFrame frame = scene_.frame(T_scene_D, static_cast<uint64_t>(i));
      std::vector<uchar> jpeg;
      cv::imencode(".jpg", frame.color, jpeg);
      keyframe->color = {
          {jpeg.begin(), jpeg.end()}, colorCamera(frame), frame.T_C_D.value_or(Pose::Identity())};
      keyframe->stamp_s = 0.1 * i;
      keyframes_.push_back(keyframe);
      truth_.push_back(T_scene_D);
    }
    parameters_.map.voxel_size_m = 0.01f;
  }

  void fuseAll(MapRefinement& refinement, bool corrected) const {
    for (size_t i = 0; i < keyframes_.size(); ++i)
      refinement.fuse(*keyframes_[i], corrected ? truth_[i] : keyframes_[i]->T_W_D);
  }
  static TriangleMesh meshOf(MapRefinement& refinement) {
    TriangleMesh mesh;
    exportSurfaceMesh(compute(), refinement.submaps().map(), mesh);
    return mesh;
  }
  MeshError errorOf(bool corrected) const {
    MapRefinement refinement(compute(), parameters_);
    fuseAll(refinement, corrected);
    return compareMesh(meshOf(refinement), Pose::Identity(), scene_.surface());
  }

  LoopScene scene_{"large_room"};
  PipelineParameters parameters_;
  Keyframes keyframes_;
  std::vector<Pose> truth_;
};

TEST_F(MapRefined, IsWhereTheKeyframesAreByNow) {
  EXPECT_GT(errorOf(false).surface_m.mean, 0.02);
  EXPECT_LT(errorOf(true).surface_m.mean, 0.01);
}

TEST_F(MapRefined, MayBeFinerAndColoured) {
  parameters_.map.color = true;
  parameters_.map.voxel_size_m = 0.02f;
  MapRefinement coarse(compute(), parameters_);
  fuseAll(coarse, true);
  parameters_.map.voxel_size_m = 0.01f;
  MapRefinement fine(compute(), parameters_);
  fuseAll(fine, true);
  const TriangleMesh mesh = meshOf(fine);
  EXPECT_GT(mesh.triangles.size(), 3 * meshOf(coarse).triangles.size());
  ASSERT_EQ(mesh.colors.size(), mesh.vertices.size());
  const auto [dark, bright] =
      std::minmax_element(mesh.colors.begin(), mesh.colors.end(),
                          [](const MeshColor& a, const MeshColor& b) { return a[1] < b[1]; });
  EXPECT_GT((*bright)[1] - (*dark)[1], 50);
}

TEST_F(MapRefined, IsSavedAndTakesAnotherMapsPlace) {
  MapRefinement refinement(compute(), parameters_);
  fuseAll(refinement, true);
  TemporaryFolder folder;
  MapSaver saver(folder / "refined.map");
  const SaveReport saved =
      refinement.save(saver, keyframes_.front()->features.camera, {0.7, truth_.back()}, keyframes_);
  EXPECT_EQ(saved.blocks, refinement.submaps().blockCount());
  BlockMap map(compute(), parameters_.map);
  SubmapCollection submaps(map, parameters_.submaps);
  const auto database = openDatabase(folder / "refined.map", DatabaseAccess::kRead);
  ReadMap read(*database, submaps);
  EXPECT_TRUE(read.loaded().description.last_pose.T_W_D.isApprox(truth_.back()));
  EXPECT_EQ(read.loaded().keyframes.size(), keyframes_.size());
  read.moveTo(submaps);
  EXPECT_EQ(submaps.blockCount(), saved.blocks);
}

TEST_F(MapRefined, IsOfNothingWhereKeyframesHaveNoView) {
  MapRefinement refinement(compute(), parameters_);
  refinement.fuse(Keyframe(), Pose::Identity());
  EXPECT_TRUE(refinement.submaps().isEmpty());
}

}  // namespace
}  // namespace depth_fusion
