#include "apps/reconstruct/second_pass.h"

#include <utility>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

std::optional<RgbdFrame> nextReadable(Recording& recording) {
  for (size_t unreadable = 0; unreadable <= recording.frameCount(); ++unreadable) {
    try {
      return recording.next();
    } catch (const Error&) {
      continue;
    }
  }
  return std::nullopt;
}

}  // namespace

void fuseAgain(Recording& recording, const Corrections& keyframes, ReconstructionPipeline& pipeline,
               RunLog& log, const std::atomic<bool>& interrupted) {
  const Trajectory& trajectory = log.trajectory();
  size_t frames = 0;
  uint32_t part = 0;
  while (!interrupted && frames < trajectory.size()) {
    const std::optional<RgbdFrame> frame = nextReadable(recording);
    if (!frame) break;
    const std::optional<Pose> T_W_D = poseAt(trajectory, frame->stamp_s, 0.0);
    if (!T_W_D) continue;
    const uint32_t part_now = keyframes.partAt(frame->stamp_s);
    if (part_now != std::exchange(part, part_now))
      check(pipeline.submaps().beginPart(), pipeline.submaps().problem());
    pipeline.processFrame(*frame, *T_W_D);
    log.showSecondPass(++frames, false);
  }
  log.showSecondPass(frames, true);
  if (interrupted) log.complain("interrupted; the map has the first " + std::to_string(frames) + " frames");
}

}  // namespace depth_fusion
