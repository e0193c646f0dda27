// The service and the action export_mesh.
#pragma once

#include <actionlib/server/simple_action_server.h>
#include <depth_fusion/ExportMeshAction.h>
#include <ros/callback_queue.h>
#include <ros/spinner.h>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "depth_fusion/common/stage_timers.h"
#include "ros/callbacks/callback_gate.h"
#include "ros/output/mesh_export.h"

namespace depth_fusion {

class MeshExportServer {
 public:
  // What is exported now, and how.
  struct Source {
    std::shared_ptr<SharedMap> map;
    MeshExportParameters parameters;
  };

  // Serves them in the handle's namespace, each in threads of its own, so that goals are cancelled while the
  // service is at work. `source` throws Error if there is nothing to export from.
  MeshExportServer(ros::NodeHandle handle, const CallbackGate& callbacks, std::function<Source()> source,
                   std::function<void(const StageTimers&)> record_timings);
  // Gives up the goal at work. The gate is closed before.
  ~MeshExportServer();

  // What became of the last export; empty before the first.
  std::string last() const;

 private:
  using ActionServer = actionlib::SimpleActionServer<ExportMeshAction>;

  // To a file, or to the mesh if that is not null. What goes wrong is the response's message.
  ExportMesh::Response serve(const ExportMesh::Request& request, const ExportProgress& progress,
                             MeshGeometry* mesh);
  ExportMesh::Response exportNow(const ExportMesh::Request& request, const ExportProgress& progress,
                                 MeshGeometry* mesh);
  void execute(const ExportMeshGoal& goal);
  // Throws Error if nobody wants the goal at work any more.
  void tell(double done);

  const std::function<Source()> source_;
  const std::function<void(const StageTimers&)> record_timings_;
  mutable std::mutex mutex_;
  std::string last_;
  std::atomic<bool> ends_{false};
  ros::CallbackQueue service_queue_, action_queue_;
  ros::ServiceServer service_;
  std::unique_ptr<ActionServer> action_;
  ros::AsyncSpinner service_spinner_{1, &service_queue_}, action_spinner_{1, &action_queue_};
};

}  // namespace depth_fusion
