#include "depth_fusion/acquisition/frame_buffers.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

TEST(FrameBuffers, TheReaderGetsTheVeryMemory) {
  FrameBuffers buffers;
  uint8_t* data = buffers.allocate(100);
  data[99] = 7;
  const auto bytes = buffers.take(data);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(bytes->data(), data);
  EXPECT_EQ(bytes->size(), 100u);
  EXPECT_EQ(bytes->at(99), 7);
}

TEST(FrameBuffers, MemoryOfOthersIsNotTaken) {
  FrameBuffers buffers;
  const uint8_t other = 0;
  EXPECT_FALSE(buffers.take(&other));
  const uint8_t* data = buffers.allocate(10);
  EXPECT_TRUE(buffers.take(data));
  EXPECT_FALSE(buffers.take(data)) << "only once";
}

TEST(FrameBuffers, IsUsedAgainOnlyWhenDriverAndReaderHaveDone) {
  FrameBuffers buffers;
  const uint8_t* data = buffers.allocate(10);
  auto bytes = buffers.take(data);
  buffers.recycle(std::move(*bytes));
  EXPECT_NE(buffers.allocate(10), data) << "the driver has it yet";
  buffers.release(data);
  EXPECT_EQ(buffers.allocate(10), data);

  bytes = buffers.take(data);
  buffers.release(data);
  EXPECT_NE(buffers.allocate(10), data) << "the reader has it yet";
  buffers.recycle(std::move(*bytes));
  EXPECT_EQ(buffers.allocate(10), data);

  buffers.release(data);
  EXPECT_EQ(buffers.allocate(10), data) << "never read";
}

}  // namespace
}  // namespace depth_fusion
