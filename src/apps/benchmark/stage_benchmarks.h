// benchmark suite: the stages of the pipeline, their parts and their kernels, on one frame in the middle of a
// recording.
#pragma once

#include "apps/benchmark/stage_fixture.h"

namespace depth_fusion {

// Registers, for what the fixture's stages turn out to do,
//   stage/STAGE/INPUT         a frame's work in a stage, as wall clock
//   stage/STAGE/PART/INPUT    a part that the stage times itself
//   kernel/STAGE/KERNEL/INPUT         the kernel's launches of a frame, as the device measures them
//   kernel/STAGE/KERNEL/levelN/INPUT  one launch on level N of a pyramid, 0 being the full image
void registerStageBenchmarks(StageFixture& fixture, const std::string& input);

}  // namespace depth_fusion
