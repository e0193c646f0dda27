// A map that is emptied, saved and loaded again and again takes no more memory than at first.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "support/room_frames.h"
#include "support/temporary_folder.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kSmallCamera{160, 120, 131.25, 131.25, 79.5, 59.5};
constexpr double kMostGrowth = 1.01;

// In bytes.
double residentBytes() {
  double pages = 0.0, resident = 0.0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

class MapMemory : public testing::Test {
 protected:
  void fuse() {
    for (const RgbdFrame& frame : frames_) pipeline_.processFrame(frame, *frame.T_W_D);
  }

  const std::vector<RgbdFrame> frames_ = simulateRoom(kSmallCamera, 2);
  PipelineParameters parameters_ = coarseRoomParameters();
  ReconstructionPipeline pipeline_{compute(), parameters_, kSmallCamera};
};

TEST_F(MapMemory, OfAThousandResetsIsThatOfSome) {
  double after_some = 0.0;
  for (int i = 0; i < 1000; ++i) {
    if (i == 100) after_some = residentBytes();
    pipeline_.map().reset(Eigen::Vector3d::Zero());
    fuse();
  }
  EXPECT_LT(residentBytes(), kMostGrowth * after_some);
}

TEST_F(MapMemory, OfAHundredSavesAndLoadsIsThatOfSome) {
  TemporaryFolder folder;
  const std::string path = folder / "room.map";
  MapSaver saver(path);
  fuse();
  const size_t blocks = pipeline_.submaps().blockCount();
  double after_some = 0.0;
  for (int i = 0; i < 100; ++i) {
    if (i == 20) after_some = residentBytes();
    pipeline_.save(saver);
    pipeline_.load(*openDatabase(path, DatabaseAccess::kRead));
    ASSERT_EQ(pipeline_.submaps().blockCount(), blocks);
    fuse();
  }
  EXPECT_LT(residentBytes(), kMostGrowth * after_some);
}

}  // namespace
}  // namespace depth_fusion
