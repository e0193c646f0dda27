#include "ros/output/mesh_export_server.h"

#include <utility>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

ExportMesh::Request requestOf(const ExportMeshGoal& goal) {
  ExportMesh::Request request;
  request.path = goal.path;
  request.format = goal.format;
  request.color = goal.color;
  request.simplification = goal.simplification;
  request.max_triangles = goal.max_triangles;
  request.max_error = goal.max_error;
  request.min_island = goal.min_island;
  request.max_hole = goal.max_hole;
  request.texture = goal.texture;
  return request;
}

ros::NodeHandle withQueue(ros::NodeHandle handle, ros::CallbackQueue& queue) {
  handle.setCallbackQueue(&queue);
  return handle;
}

}  // namespace

MeshExportServer::MeshExportServer(ros::NodeHandle handle, const CallbackGate& callbacks,
                                   std::function<Source()> source,
                                   std::function<void(const StageTimers&)> record_timings)
    : source_(std::move(source)), record_timings_(std::move(record_timings)) {
  ros::NodeHandle service_handle = withQueue(handle, service_queue_);
  service_ = callbacks.advertiseService<ExportMesh::Request, ExportMesh::Response>(
      service_handle, "export_mesh", [this](const auto& request, auto& response) {
        response = serve(request, nullptr, nullptr);
        return true;
      });
  action_ = std::make_unique<ActionServer>(
      withQueue(handle, action_queue_), "export_mesh",
      [this](const ExportMeshGoalConstPtr& goal) { execute(*goal); }, false);
  action_->start();
  service_spinner_.start();
  action_spinner_.start();
}

MeshExportServer::~MeshExportServer() {
  ends_ = true;
  action_spinner_.stop();  // actionlib's timer must be over before its server is destroyed
  action_.reset();
}

std::string MeshExportServer::last() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return last_;
}

ExportMesh::Response MeshExportServer::serve(const ExportMesh::Request& request,
                                             const ExportProgress& progress, MeshGeometry* mesh) {
  ExportMesh::Response response;
  try {
    response = exportNow(request, progress, mesh);
  } catch (const std::exception& error) {
    response.success = false;
    response.message = error.what();
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  last_ = (response.success ? mesh == nullptr ? "" : "to a message " : "failed: ") + response.message;
  return response;
}

ExportMesh::Response MeshExportServer::exportNow(const ExportMesh::Request& request,
                                                 const ExportProgress& progress, MeshGeometry* mesh) {
  StageTimers timers;
  ExportMesh::Response response;
  {
    const StageTimers::Scope timer(timers, "surface_mesh/export");
    const Source source = source_();
    response = exportMesh(*source.map, request, source.parameters, progress, mesh);
  }
  record_timings_(timers);
  return response;
}

void MeshExportServer::execute(const ExportMeshGoal& goal) {
  ExportMeshResult result;
  MeshGeometry* const mesh = goal.path.empty() ? &result.mesh : nullptr;
  const ExportMesh::Response response = serve(
      requestOf(goal), [this](double done) { tell(done); }, mesh);
  result.message = response.message;
  result.vertices = response.vertices;
  result.triangles = response.triangles;
  result.bytes = response.bytes;
  if (response.success) return action_->setSucceeded(result, response.message);
  result.mesh = {};
  if (action_->isPreemptRequested()) return action_->setPreempted(result, response.message);
  action_->setAborted(result, response.message);
}

void MeshExportServer::tell(double done) {
  check(!ends_, "the nodelet ends; nothing was exported");
  check(!action_->isPreemptRequested(), "cancelled; nothing was exported");
  ExportMeshFeedback feedback;
  feedback.done = static_cast<float>(done);
  action_->publishFeedback(feedback);
}

}  // namespace depth_fusion
