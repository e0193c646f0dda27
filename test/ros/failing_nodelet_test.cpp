// A nodelet that fails at its start takes nothing down with it, whatever it offers by then.
#include <nodelet/loader.h>

#include <atomic>
#include <boost/make_shared.hpp>
#include <thread>

#include "ros/in_process/worker.h"
#include "ros/nodelets/stage_nodelet.h"
#include "support/diagnostics.h"

namespace depth_fusion {
namespace {

// Advertises, subscribes, has threads and timers, and then cannot work after all, as long as it is told to.
class FailingNodelet : public StageNodelet {
 public:
  inline static std::atomic<bool> fails{true};

  ~FailingNodelet() override {
    stopServing();
    subscriber_.shutdown();
    if (worker_ != nullptr) worker_->stop();
  }

 private:
  void start() override {
    loadParameters({number("gate", &gate_, 0.0, 1.0, "of the test")});
    worker_ = std::make_unique<Worker<int>>(
        2, [](int) { ros::WallDuration(0.001).sleep(); }, [this](int) { counter_.drop(kTooSlow); });
    publisher_ = getMTPrivateNodeHandle().advertise<StageTimings>("news", 10);
    subscriber_ =
        getMTNodeHandle().subscribe<StageTimings>("input", 10, [this](const StageTimings::ConstPtr&) {
          counter_.receive();
          worker_->push(1);
        });
    startReporting();
    ros::WallDuration(0.02).sleep();  // meanwhile others call
    check(!fails, "it cannot work after all");
  }
  void betweenFrames(const std::function<void()>& action) override { worker_->between(action); }
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) override { status.add("gate", gate_); }

  float gate_ = 0.5f;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  std::unique_ptr<Worker<int>> worker_;
};

// Sends images and changes parameters without a pause.
class Others {
 public:
  explicit Others(ros::NodeHandle handle)
      : publisher_(handle.advertise<StageTimings>("input", 10)), caller_([this, handle]() mutable {
          ros::ServiceClient client =
              handle.serviceClient<dynamic_reconfigure::Reconfigure>("failing/set_parameters");
          while (!done_) {
            publisher_.publish(StageTimings());
            dynamic_reconfigure::Reconfigure service;
            client.call(service);
            ros::WallDuration(0.001).sleep();
          }
        }) {}
  ~Others() {
    done_ = true;
    caller_.join();
  }

 private:
  std::atomic<bool> done_{false};
  ros::Publisher publisher_;
  std::thread caller_;
};

TEST(FailingNodelets, LeaveTheirManagerAsItWas) {
  NodeletGraph graph("failing_nodelet");
  nodelet::Loader manager(boost::function<boost::shared_ptr<nodelet::Nodelet>(const std::string&)>(
      [](const std::string&) { return boost::make_shared<FailingNodelet>(); }));
  const Diagnostics diagnostics(graph.handle());
  const Others others(graph.handle());
  Listener<StageTimings> news(graph.handle(), "failing/news");
  for (int i = 0; i < 20; ++i)
    EXPECT_FALSE(manager.load(graph.resolve("failing"), "FailingNodelet", {}, {})) << i;
  FailingNodelet::fails = false;
  ASSERT_TRUE(manager.load(graph.resolve("failing"), "FailingNodelet", {}, {}));
  EXPECT_TRUE(diagnostics.says("failing", diagnostic_msgs::DiagnosticStatus::OK, "running"));
  manager.unload(graph.resolve("failing"));
}

}  // namespace
}  // namespace depth_fusion
