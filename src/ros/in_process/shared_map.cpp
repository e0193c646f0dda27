#include "ros/in_process/shared_map.h"

#include <map>

#include "depth_fusion/pipeline/stored_map.h"

namespace depth_fusion {
namespace {

// What others hold, by name.
template <class Value>
struct Registry {
  std::mutex mutex;
  std::map<std::string, std::weak_ptr<Value>> values;
};

template <class Value>
Registry<Value>& registry() {
  static Registry<Value> instance;
  return instance;
}

}  // namespace

std::shared_ptr<ComputeContext> sharedCompute(const std::string& device) {
  Registry<ComputeContext>& contexts = registry<ComputeContext>();
  const std::lock_guard<std::mutex> lock(contexts.mutex);
  std::weak_ptr<ComputeContext>& known = contexts.values[device];
  std::shared_ptr<ComputeContext> context = known.lock();
  if (context == nullptr) known = context = std::make_shared<ComputeContext>(device);
  return context;
}

void FusedMap::reset() {
  map_.reset(Eigen::Vector3d::Zero());
  mapper_.reset();
}

void FusedMap::load(ReadMap& stored, const std::string& name) {
  checkFilterRule(stored.loaded().description, parameters_, name);
  stored.moveTo(submaps_);
  mapper_.reset();
}

Mapper& FusedMap::mapper(const CameraIntrinsics& camera) {
  if (mapper_ == nullptr || !sameCamera(camera, camera_)) {
    mapper_ = std::make_unique<Mapper>(compute_, map_, submaps_, parameters_, camera);
    camera_ = camera;
  }
  return *mapper_;
}

void FusedMap::setParameters(const PipelineParameters& parameters) {
  if (mapper_ != nullptr) mapper_->setParameters(parameters);
  parameters_ = parameters;
}

Keyframes SharedMap::keyframesOf(uint32_t generation) const {
  const std::lock_guard<std::mutex> lock(keyframes_mutex_);
  return generation == keyframes_generation_ ? keyframes_ : Keyframes();
}

void SharedMap::keepKeyframes(uint32_t generation, const Keyframes& keyframes) {
  const std::lock_guard<std::mutex> lock(keyframes_mutex_);
  if (generation < keyframes_generation_) return;  // a tracker that has not heard of this map yet
  keyframes_generation_ = generation;
  keyframes_ = keyframes;
}

void offerMap(const std::string& name, const std::shared_ptr<SharedMap>& map) {
  Registry<SharedMap>& maps = registry<SharedMap>();
  const std::lock_guard<std::mutex> lock(maps.mutex);
  maps.values[name] = map;
}

std::shared_ptr<SharedMap> findMap(const std::string& name) {
  Registry<SharedMap>& maps = registry<SharedMap>();
  const std::lock_guard<std::mutex> lock(maps.mutex);
  const auto found = maps.values.find(name);
  return found == maps.values.end() ? nullptr : found->second.lock();
}

}  // namespace depth_fusion
