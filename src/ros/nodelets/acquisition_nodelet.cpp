// Acquisition: publishes the frames of a recording or of a camera.
#include <pluginlib/class_list_macros.hpp>
#include <thread>

#include "ros/input/device_publisher.h"
#include "ros/input/recording_player.h"
#include "ros/nodelets/stage_nodelet.h"

namespace depth_fusion {

class AcquisitionNodelet : public StageNodelet {
 public:
  ~AcquisitionNodelet() override;

 private:
  void start() override;
  void applyParameters() override;
  std::unique_ptr<FrameSource> makeSource();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) override { source_->diagnose(status); }

  PlayerParameters player_parameters_;
  DevicePublisherParameters device_parameters_;
  std::unique_ptr<FrameSource> source_;
  std::thread thread_;
};

AcquisitionNodelet::~AcquisitionNodelet() {
  stopServing();
  if (source_) source_->stop();
  if (thread_.joinable()) thread_.join();
}

void AcquisitionNodelet::start() {
  ParameterTable table = player_parameters_.table();
  const ParameterTable device_table = device_parameters_.table();
  table.insert(table.end(), device_table.begin(), device_table.end());
  loadParameters(table);
  source_ = makeSource();
  startReporting();
  thread_ = std::thread([this] { source_->run(); });
}

void AcquisitionNodelet::applyParameters() {
  if (source_) source_->applyParameters();
}

std::unique_ptr<FrameSource> AcquisitionNodelet::makeSource() {
  const std::string& device_id = device_parameters_.device.device_id;
  PlayerParameters player = player_parameters_;
  check(player.recording.empty() != device_id.empty(),
        "give the parameter recording (a file or folder) or device_id (a camera; #1 is the first), and not "
        "both");
  if (endsWith(device_id, ".oni")) player.recording = device_id;
  const SourceHost host{getMTNodeHandle(), getName(), counter_,
                        [this](const StageTimers& timers) { recordTimings(timers); }};
  if (!player.recording.empty()) return std::make_unique<RecordingPlayer>(host, player);
  return std::make_unique<DevicePublisher>(host, device_parameters_);
}

}  // namespace depth_fusion

PLUGINLIB_EXPORT_CLASS(depth_fusion::AcquisitionNodelet, nodelet::Nodelet)
