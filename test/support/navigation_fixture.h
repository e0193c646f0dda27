// The nodelet navigation with a map into which a test fuses a simulated room.
#pragma once

#include <memory>
#include <string>

#include "ros/in_process/shared_map.h"
#include "support/esdf_scene.h"
#include "support/nodelet_graph.h"

namespace depth_fusion {

class NavigationTest : public testing::Test {
 protected:
  NavigationTest()
      : graph_("navigation"),
        map_(std::make_shared<SharedMap>(sharedCompute(""), parameters(), "map")),
        preprocessor_(*map_->compute, nearRange(), kWideCamera) {
    offerMap(graph_.resolve("tsdf_fusion"), map_);
    graph_.handle().setParam("esdf/frame_stride", 1);
    graph_.handle().setParam("navigation/publish_rate_hz", 20.0);
  }

  void load() { ASSERT_TRUE(graph_.load("navigation")); }
  // Fuses as tsdf_fusion does, at the rate of a sensor.
  void lookAround(int frames) {
    for (int i = 0; i < frames; ++i) {
      const Pose T_W_D = poseLookingAround(i, frames);
      const RgbdFrame frame = frameOfScene(scene_, T_W_D, i);
      map_->locked([&](FusedMap& fused) {
        StageTimers timers;
        preprocessor_.process(frame, Vector6d::Zero(), timers);
        fused.mapper(kWideCamera).fuse(frame, *preprocessor_.result(), T_W_D, true, timers);
        fused.tell(preprocessor_.result(), T_W_D);
      });
      ros::WallDuration(0.05).sleep();
    }
  }
  bool isFollowed() {
    return map_->locked([](FusedMap& fused) { return fused.map().isFollowed(); });
  }
  template <class Service>
  bool call(const std::string& name, Service& service) {
    ros::ServiceClient client = graph_.handle().serviceClient<Service>("navigation/" + name);
    return client.waitForExistence(ros::Duration(kPatience_s)) && client.call(service);
  }

  NodeletGraph graph_;
  const Scene scene_{closedRoom()};
  std::shared_ptr<SharedMap> map_;
  DepthPreprocessor preprocessor_;

 private:
  static PipelineParameters parameters() {
    PipelineParameters parameters;
    parameters.map = esdfSceneMap();
    return parameters;
  }
};

}  // namespace depth_fusion
