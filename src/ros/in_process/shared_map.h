// What the nodelets of one process share: the compute device and the map.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "depth_fusion/pipeline/mapper.h"
#include "depth_fusion/submaps/map_file.h"

namespace depth_fusion {

// One context a device choice for the whole process; it lives as long as somebody holds it. Throws Error
// without a device.
std::shared_ptr<ComputeContext> sharedCompute(const std::string& device);

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
  void noteCameraPosition(const Eigen::Vector3d& camera_W) { camera_W_ = camera_W; }
  // Empties the map; a new generation begins.
  void reset();
  // Takes in a stored map in place of what there is. Throws Error, and changes nothing, if it was filtered by
  // another rule.
  void load(ReadMap& stored, const std::string& name);
  // The parameters are for the frames to come; the map's stay. Throws Error for what cannot change.
  void setParameters(const PipelineParameters& parameters);

 private:
  ComputeContext& compute_;
  PipelineParameters parameters_;
  BlockMap map_;
  SubmapCollection submaps_;
  CameraIntrinsics camera_;
  Eigen::Vector3d camera_W_ = Eigen::Vector3d::Zero();
  std::unique_ptr<Mapper> mapper_;
};

// A map that several threads work on, one after the other.
class SharedMap {
 public:
  SharedMap(std::shared_ptr<ComputeContext> context, const PipelineParameters& parameters,
            const std::string& frame)
      : compute(std::move(context)), frame_id(frame), fused_(*compute, parameters) {}

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

  const std::shared_ptr<ComputeContext> compute;
  const std::string frame_id;  // of the map's coordinates

 private:
  std::mutex mutex_;
  FusedMap fused_;
  mutable std::mutex keyframes_mutex_;  // of the two that follow
  uint32_t keyframes_generation_ = 0;
  Keyframes keyframes_;
};

// Makes the map known by the resolved name of the nodelet that has it.
void offerMap(const std::string& name, const std::shared_ptr<SharedMap>& map);
// Null if no nodelet of that name in this process has a map (yet).
std::shared_ptr<SharedMap> findMap(const std::string& name);

}  // namespace depth_fusion
