// Loops are sought and closed beside tracking: fused frames become keyframes, which a loop closer compares on
// a thread of its own.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "depth_fusion/frames/model_view.h"
#include "depth_fusion/frames/rgbd_frame.h"
#include "depth_fusion/loops/loop_closer.h"
#include "depth_fusion/loops/loop_parameters.h"
#include "depth_fusion/store/database.h"

namespace depth_fusion {

// What loops are sought for. A recording is there to be fused again: add() waits while there is too much to
// compare, so that it gives the same every time. A live map is made anew from views, which are kept also
// between keyframes: add() leaves frames out while there is too much to do, so that no sensor has to wait.
enum class LoopsFor { kRecording, kLiveMap };

// Any thread may call. Keyframes lie in a file for this process alone, so that memory holds little more than
// the graph and the index.
class LoopClosing {
 public:
  // `keeps_color`: keyframes have their colour image, too.
  explicit LoopClosing(const LoopParameters& parameters, LoopsFor use = LoopsFor::kRecording,
                       bool keeps_color = false);
  ~LoopClosing();

  // A frame was fused at T_W_D, from where the map looks like `view`. It becomes a keyframe if it has
  // features and is far enough from the last one; of a live map also without, nearer, as a view alone. W is
  // as it was after so many calls of adopt(): frames of another W are left out.
  void add(const RgbdFrame& frame, const FrameFeatures& features, const Pose& T_W_D, const ModelView& view,
           uint32_t world = 0);
  // Nothing is known of how the frames to come lie to those before.
  void beginAnew();
  // The map is where these corrections have it from now on, which are of keyframes(): poses given before
  // count as moved accordingly. Returns what add() is then told as `world`.
  uint32_t adopt(const Corrections& applied);

  // Waits until all keyframes that there are now are compared.
  void finish();
  // Places that were compared since the last call, and older ones whose verdict changed.
  std::vector<LoopCandidate> takeCandidates();
  // All keyframes so far, in the order of their numbers.
  Corrections keyframes() const;
  // What loops have made of the poses since the last adopt(); without keyframes if nothing.
  Corrections corrections() const;
  // Whether loops have joined parts since then.
  bool joinsParts() const;
  // Throws Error if it cannot be read back.
  KeyframePtr keyframe(uint32_t number);
  // Why loops are not sought any more; empty if all is well.
  std::string problem() const;

 private:
  struct Waiting {
    std::shared_ptr<Keyframe> keyframe;
    cv::Mat color;
    std::optional<KeyframeMotion> motion;
    Pose T_W_then;
  };

  enum class Role { kNone, kView, kKeyframe };
  Role roleOf(const FrameFeatures& features, const Pose& T_W_D) const;
  bool isOf(uint32_t world) const { return world == world_; }
  void run();
  void compare(LoopCloser& closer, Waiting& added, LoopReport& report);
  void keep(uint32_t number, const Keyframe& keyframe);
  // The pose of each keyframe, by all that is known.
  void note(const LoopCloser& closer, const LoopReport& report);

  const LoopParameters parameters_;
  const LoopsFor use_;
  const bool keeps_color_;

  std::mutex store_mutex_;               // of the one that follows
  std::unique_ptr<Database> keyframes_;  // null before the first

  mutable std::mutex mutex_;  // of all below
  std::condition_variable has_work_, is_idle_;
  uint32_t world_ = 0;
  double way_m_ = 0.0;
  std::optional<Pose> last_W_, last_keyframe_W_, last_view_W_;  // a keyframe is a view, too
  std::deque<Waiting> waiting_;                                 // the first one is at work
  std::vector<LoopCandidate> candidates_;
  std::vector<CorrectedKeyframe> known_;
  bool is_moved_ = false, joins_parts_ = false;  // since the last adopt()
  std::string problem_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace depth_fusion
