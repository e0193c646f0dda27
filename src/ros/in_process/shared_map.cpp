#include "ros/in_process/shared_map.h"

#include <algorithm>
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
  was_loaded_ = false;
  clearings_.clear();
  mapper_.reset();
}

void FusedMap::noteFrame(double stamp_s, const Eigen::Vector3d& camera_W) {
  last_stamp_s_ = stamp_s;
  camera_W_ = camera_W;
}

void FusedMap::tell(const std::shared_ptr<const DepthFrame>& depth, const Pose& T_W_D) {
  const auto is_gone = [&](const std::weak_ptr<const FrameListener>& listener) {
    const std::shared_ptr<const FrameListener> held = listener.lock();
    if (held != nullptr) (*held)(depth, T_W_D, map_.generation());
    return held == nullptr;
  };
  listeners_.erase(std::remove_if(listeners_.begin(), listeners_.end(), is_gone), listeners_.end());
}

size_t FusedMap::clear(const Clearing& clearing) {
  clearings_.emplace_back(last_stamp_s_, clearing);
  return submaps_.clear(clearing.box_W, clearing.isInside);
}

void FusedMap::load(ReadMap& stored, const std::string& name) {
  replace(stored, name);
  was_loaded_ = true;
  clearings_.clear();
}

void FusedMap::replace(ReadMap& refined, const std::string& name) {
  checkFilterRule(refined.loaded().description, parameters_, name);
  refined.moveTo(submaps_);
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

LoopsOfMap SharedMap::loopsOf(uint32_t generation) const {
  const std::lock_guard<std::mutex> lock(loops_mutex_);
  return generation == loops_generation_ ? loops_ : LoopsOfMap();
}

void SharedMap::setLoops(uint32_t generation, LoopsOfMap loops) {
  const std::lock_guard<std::mutex> lock(loops_mutex_);
  loops_generation_ = generation;
  loops_ = std::move(loops);
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
