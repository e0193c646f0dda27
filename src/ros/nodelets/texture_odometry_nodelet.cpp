// Texture odometry: the motion between frames from their texture, for tracking.
#include <pluginlib/class_list_macros.hpp>

#include "depth_fusion/texture_odometry/texture_odometry.h"
#include "ros/in_process/worker.h"
#include "ros/input/rgbd_subscriber.h"
#include "ros/nodelets/stage_nodelet.h"
#include "ros/parameters/shared_rows.h"

namespace depth_fusion {

class TextureOdometryNodelet : public StageNodelet {
 public:
  ~TextureOdometryNodelet() override {
    stopServing();
    if (worker_ != nullptr) worker_->stop();
    subscriber_.reset();
  }

 private:
  void start() override;
  void applyParameters() override;
  void betweenFrames(const std::function<void()>& action) override { worker_->between(action); }
  void process(const RgbdMessagesPtr& messages);
  void findMotion(const SensorFramePtr& sensor);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  TextureOdometryParameters parameters_;
  DepthSensorParameters depth_sensor_;
  RgbdParameters rgbd_;
  std::string device_;
  int queue_size_ = 2;
  std::unique_ptr<TextureOdometry> odometry_;
  std::shared_ptr<const TextureOdometryParameters>
      odometry_parameters_;  // the same, for those who get the frames
  uint32_t clock_jumps_ = 0;
  ros::Publisher frame_publisher_;
  std::mutex status_mutex_;
  std::string no_motion_;  // why the last frame has no motion
  std::unique_ptr<Worker<RgbdMessagesPtr>> worker_;
  std::unique_ptr<RgbdSubscriber> subscriber_;
};

void TextureOdometryNodelet::start() {
  ParameterTable table = parameters_.table();
  for (const Parameter& row : rgbd_.table()) table.push_back(row);
  table.push_back(deviceRow(device_));
  table.push_back(queueSizeRow(queue_size_));
  loadParameters(table, {{"registration", rgbd_.registration.table()},
                         {"masking", rgbd_.masking.table()},
                         {"depth_sensor", depth_sensor_.table()}});
  odometry_ = std::make_unique<TextureOdometry>(parameters_, depth_sensor_);

  ros::NodeHandle& handle = getMTPrivateNodeHandle();
  frame_publisher_ = handle.advertise<TexturedFrameMessage>("frame", kProcessQueue);
  worker_ = std::make_unique<Worker<RgbdMessagesPtr>>(
      queue_size_, [this](const RgbdMessagesPtr& messages) { process(messages); },
      [this](const RgbdMessagesPtr&) { counter_.drop(kTooSlow); });
  // The worker's thread makes it, so that no frame is at work before it is there.
  worker_->between([this] {
    subscriber_ = std::make_unique<RgbdSubscriber>(
        getMTNodeHandle(), rgbd_, device_, counter_,
        [this](const RgbdMessagesPtr& messages) { worker_->push(messages); });
  });
  startReporting();
}

void TextureOdometryNodelet::applyParameters() {
  rgbd_.checkTexts();
  odometry_parameters_ = std::make_shared<TextureOdometryParameters>(parameters_);
  if (odometry_ != nullptr) odometry_->setParameters(parameters_, depth_sensor_);
  if (subscriber_ != nullptr) subscriber_->setParameters(rgbd_);
}

void TextureOdometryNodelet::process(const RgbdMessagesPtr& messages) {
  try {
    if (const SensorFramePtr sensor = subscriber_->decode(*messages)) findMotion(sensor);
  } catch (const std::exception& error) {
    counter_.drop("error");
    NODELET_ERROR_STREAM_THROTTLE(5.0, getName() << ": " << error.what());
  }
}

void TextureOdometryNodelet::findMotion(const SensorFramePtr& sensor) {
  StageTimers timers;
  if (sensor->clock_jumps != std::exchange(clock_jumps_, sensor->clock_jumps)) odometry_->reset();
  const auto frame = std::make_shared<TexturedSensorFrame>(
      TexturedSensorFrame{sensor, odometry_->texture(sensor->rgbd, timers), odometry_parameters_});
  recordTimings(timers);
  counter_.process();
  {
    const std::lock_guard<std::mutex> lock(status_mutex_);
    no_motion_ = frame->texture.motion.reason;
  }
  frame_publisher_.publish(makeMessage<TexturedSensorFrame>(sensor->header, frame));
}

void TextureOdometryNodelet::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::string problem = subscriber_->problem();
  const std::lock_guard<std::mutex> lock(status_mutex_);
  if (!problem.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, problem);
  } else if (!subscriber_->hasColor()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK,
                   "nobody publishes colour; tracking goes by depth alone");
  } else if (!no_motion_.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "no motion: " + no_motion_);
  }
  status.add("queue", worker_->waiting());
  status.add("trackers", frame_publisher_.getNumSubscribers());
}

}  // namespace depth_fusion

PLUGINLIB_EXPORT_CLASS(depth_fusion::TextureOdometryNodelet, nodelet::Nodelet)
