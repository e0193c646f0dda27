// What the nodelets of one process share: the compute device and the map.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "depth_fusion/pipeline/mapper.h"
#include "depth_fusion/surface_mesh/mesh_chunks.h"

namespace depth_fusion {

// One context a device choice for the whole process; it lives as long as somebody holds it. Throws Error
// without a device.
std::shared_ptr<ComputeContext> sharedCompute(const std::string& device);

uint32_t newGeneration();

struct SharedMap {
  SharedMap(std::shared_ptr<ComputeContext> context, const PipelineParameters& parameters)
      : compute(std::move(context)), map(*compute, parameters.map), parameters_(parameters) {}

  // The caller of these holds the mutex.
  // Empties the map.
  void reset();
  // For frames of that camera, until the next call or reset(). Throws Error if the device cannot.
  Mapper& mapper(const CameraIntrinsics& camera);
  // For the frames to come; the map's stay. Throws Error for what cannot change.
  void setParameters(const PipelineParameters& parameters);
  // Tells the chunks, as long as somebody holds them, of the blocks that change.
  void follow(const std::shared_ptr<MeshChunks>& chunks) { followers_.push_back(chunks); }
  bool isFollowed();
  void noteUpdated(const std::vector<int>& slots);

  const std::shared_ptr<ComputeContext> compute;
  std::mutex mutex;  // held by whoever reads or changes the map
  BlockSparseMap map;
  std::atomic<uint32_t> generation{
      newGeneration()};  // another one after every reset, and of every map of the process
  std::string frame_id;  // of the map's coordinates

 private:
  PipelineParameters parameters_;
  CameraIntrinsics camera_;
  std::unique_ptr<Mapper> mapper_;
  std::vector<std::weak_ptr<MeshChunks>> followers_;
};

// Makes the map known by the resolved name of the nodelet that has it.
void offerMap(const std::string& name, const std::shared_ptr<SharedMap>& map);
// Null if no nodelet of that name in this process has a map (yet).
std::shared_ptr<SharedMap> findMap(const std::string& name);

}  // namespace depth_fusion
