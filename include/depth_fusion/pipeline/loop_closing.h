// Loops are sought and closed beside tracking: fused frames become keyframes, which a loop closer compares on
// a thread of its own.
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "depth_fusion/frames/model_view.h"
#include "depth_fusion/loops/loop_closer.h"
#include "depth_fusion/loops/loop_parameters.h"
#include "depth_fusion/store/database.h"

namespace depth_fusion {

// The one who fuses calls add() and beginAnew(); any thread may call the others. Keyframes lie in a file for
// this process alone, so that memory holds little more than the graph and the index.
class LoopClosing {
 public:
  explicit LoopClosing(const LoopParameters& parameters);
  ~LoopClosing();

  // A frame was fused at T_W_D, from where the map looks like `view`. It becomes a keyframe if it has
  // features and is far enough from the last one; waits while too many are to be compared.
  void add(double stamp_s, const FrameFeatures& features, const Pose& T_W_D, const ModelView& view);
  // Nothing is known of how the frames to come lie to those before.
  void beginAnew();
  // The way of the sensor up to the last frame.
  double way_m() const { return way_m_; }

  // Waits until all keyframes are compared.
  void finish();
  // Places that were compared since the last call, and older ones whose verdict changed.
  std::vector<LoopCandidate> takeCandidates();
  // What all loops so far make of the poses; without keyframes while there are none.
  Corrections corrections() const;
  // Why loops are not sought any more; empty if all is well.
  std::string problem() const;

 private:
  struct Waiting {
    KeyframePtr keyframe;
    std::optional<KeyframeMotion> motion;
  };

  bool isKeyframe(const Pose& T_W_D) const;
  void run();
  void keep(uint32_t number, const Keyframe& keyframe);
  KeyframePtr load(uint32_t number);

  const LoopParameters parameters_;
  double way_m_ = 0.0;
  std::optional<Pose> last_W_, last_keyframe_W_;

  std::unique_ptr<Database> keyframes_;  // of the thread

  mutable std::mutex mutex_;  // of all below
  std::condition_variable has_work_, is_idle_;
  std::deque<Waiting> waiting_;  // the first one is at work
  std::vector<LoopCandidate> candidates_;
  Corrections corrections_;
  std::string problem_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace depth_fusion
