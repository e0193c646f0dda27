// What is done of the next frame beside the stages of the present one.
#pragma once

#include <future>
#include <optional>

#include "depth_fusion/pipeline/tracking_session.h"
#include "depth_fusion/robot_motion/robot_motion.h"

namespace depth_fusion {

// The one who announces a frame has to bring it next. Keeps references to odometry, robot and session.
class FrameAhead {
 public:
  FrameAhead(TextureOdometry& odometry, RobotMotion& robot, TrackingSession& session)
      : odometry_(odometry), robot_(robot), session_(session) {}

  // The texture of the frame, found now or, if the frame was announced, ahead, and what the robot knows of
  // it. Throws Error if another frame was announced, which may then still be brought.
  TexturedFrame textureOf(const RgbdFrame& frame, StageTimers& timers);
  // Announces the next frame and begins its texture odometry; null announces nothing.
  void announce(const RgbdFrame* next);
  // Begins to prepare the announced frame for tracking; the session has stepped to the frame before.
  void prepare();
  // Waits until what has begun is done.
  void wait() const;
  // Throws Error if a frame is announced.
  void checkNoneAnnounced() const;

 private:
  // What the robot knows of the frame, asked once.
  const RobotKnowledge& knowledgeOf(const RgbdFrame& frame);

  TextureOdometry& odometry_;
  RobotMotion& robot_;
  TrackingSession& session_;
  std::optional<RgbdFrame> announced_;
  std::optional<RobotKnowledge> known_;  // of the announced frame
  StageTimers timers_;                   // of what is done ahead
  std::future<TexturedFrame> texture_;   // of the announced frame; last: its task uses the others
};

}  // namespace depth_fusion
