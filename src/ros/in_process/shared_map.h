// What the nodelets of one process share: the compute device and the map.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "depth_fusion/pipeline/loop_closing.h"
#include "depth_fusion/pipeline/mapper.h"
#include "depth_fusion/submaps/map_file.h"

namespace depth_fusion {

// One context a device choice for the whole process; it lives as long as somebody holds it. Throws Error
// without a device.
std::shared_ptr<ComputeContext> sharedCompute(const std::string& device);

// A region of a map of which nothing is known any more.
struct Clearing {
  Eigen::AlignedBox3d box_W;
  std::function<bool(const Eigen::Vector3d& p_W)> isInside;
};

// Is told of each frame that is fused, from where it was seen, and of the map's generation, while the map is
// locked: it returns fast.
using FrameListener = std::function<void(const std::shared_ptr<const DepthFrame>& depth, const Pose& T_W_D,
                                         uint32_t generation)>;

// A map and what fuses into it.
class FusedMap {
 public:
  FusedMap(ComputeContext& compute, const PipelineParameters& parameters)
      : compute_(compute),
        parameters_(parameters),
        map_(compute, parameters.map),
        submaps_(map_, parameters.submaps) {}

  // The part of it that is in the pool.
  BlockMap& map() { return map_; }
  SubmapCollection& submaps() { return submaps_; }
  bool isEmpty() const { return submaps_.isEmpty(); }
  // The mapper for frames of that camera, until the next call or reset(). Throws Error if the device cannot.
  Mapper& mapper(const CameraIntrinsics& camera);
  // Where the camera was when the last frame was fused; the origin of a map without frames.
  const Eigen::Vector3d& cameraPosition() const { return camera_W_; }
  // A frame of that stamp is fused from there.
  void noteFrame(double stamp_s, const Eigen::Vector3d& camera_W);
  // Tells of frames from now on, for as long as somebody holds the listener.
  void listen(const std::shared_ptr<const FrameListener>& listener) { listeners_.push_back(listener); }
  void tell(const std::shared_ptr<const DepthFrame>& depth, const Pose& T_W_D);
  // As SubmapCollection has it; is kept in mind, for a map that is made anew.
  size_t clear(const Clearing& clearing);
  // What was cleared after the frames of these stamps, in this order.
  const std::vector<std::pair<double, Clearing>>& clearings() const { return clearings_; }
  // Whether there is more in it than what was fused since it was emptied.
  bool wasLoaded() const { return was_loaded_; }
  // Empties the map; a new generation begins.
  void reset();
  // Takes in a stored map in place of what there is. Throws Error, and changes nothing, if it was filtered by
  // another rule.
  void load(ReadMap& stored, const std::string& name);
  // Takes in this map as it was made anew. Throws Error as load() does.
  void replace(ReadMap& refined, const std::string& name);
  // The parameters are for the frames to come; the map's stay. Throws Error for what cannot change.
  void setParameters(const PipelineParameters& parameters);

 private:
  ComputeContext& compute_;
  PipelineParameters parameters_;
  BlockMap map_;
  SubmapCollection submaps_;
  CameraIntrinsics camera_;
  Eigen::Vector3d camera_W_ = Eigen::Vector3d::Zero();
  bool was_loaded_ = false;
  double last_stamp_s_ = 0.0;  // of the frame that was fused last
  std::vector<std::pair<double, Clearing>> clearings_;
  std::unique_ptr<Mapper> mapper_;
  std::vector<std::weak_ptr<const FrameListener>> listeners_;
};

// Where loops of a map are sought, and what its frames are told as LoopClosing::add's `world`.
struct LoopsOfMap {
  std::shared_ptr<LoopClosing> closing;  // null: nowhere
  uint32_t world = 0;
};

// A map that several threads work on, one after the other.
class SharedMap {
 public:
  SharedMap(std::shared_ptr<ComputeContext> context, const PipelineParameters& parameters,
            const std::string& frame)
      : compute(std::move(context)),
        frame_id(frame),
        has_color(parameters.map.color),
        fused_(*compute, parameters) {}

  // Calls function(FusedMap&) while no other thread has the map, and returns what it returns. No reference
  // into the map may outlive the call but to be used in another one.
  template <class Function>
  auto locked(const Function& function) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return function(fused_);
  }

  // The keyframes of the map of that generation, as its tracker had them last; none if it had none. Those of
  // an older map than the last are not kept. Both may be called at any time.
  Keyframes keyframesOf(uint32_t generation) const;
  void keepKeyframes(uint32_t generation, const Keyframes& keyframes);

  // Where loops of the map of that generation are sought. Both may be called at any time.
  LoopsOfMap loopsOf(uint32_t generation) const;
  void setLoops(uint32_t generation, LoopsOfMap loops);

  const std::shared_ptr<ComputeContext> compute;
  const std::string frame_id;  // of the map's coordinates
  const bool has_color;

 private:
  std::mutex mutex_;
  FusedMap fused_;
  mutable std::mutex keyframes_mutex_;  // of the two that follow
  uint32_t keyframes_generation_ = 0;
  Keyframes keyframes_;
  mutable std::mutex loops_mutex_;  // of the two that follow
  uint32_t loops_generation_ = 0;
  LoopsOfMap loops_;
};

// Makes the map known by the resolved name of the nodelet that has it.
void offerMap(const std::string& name, const std::shared_ptr<SharedMap>& map);
// Null if no nodelet of that name in this process has a map (yet).
std::shared_ptr<SharedMap> findMap(const std::string& name);

}  // namespace depth_fusion
