// Parameters change while the nodelets run, as a client of dynamic_reconfigure sees it.
#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <rosgraph_msgs/Log.h>

#include <cmath>

#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "support/nodelet_graph.h"

namespace depth_fusion {
namespace {

using dynamic_reconfigure::Config;
using dynamic_reconfigure::ConfigDescription;

template <class Values>
const typename Values::value_type* find(const Values& values, const std::string& name) {
  for (const auto& value : values) {
    if (value.name == name) return &value;
  }
  return nullptr;
}

double doubleOf(const Config& config, const std::string& name) {
  const auto* value = find(config.doubles, name);
  return value == nullptr ? NAN : value->value;
}

int intOf(const Config& config, const std::string& name) {
  const auto* value = find(config.ints, name);
  return value == nullptr ? -1 : value->value;
}

std::string textOf(const Config& config, const std::string& name) {
  const auto* value = find(config.strs, name);
  return value == nullptr ? "missing" : value->value;
}

template <class Values, class Value>
void add(Values& values, const std::string& name, const Value& value) {
  values.emplace_back();
  values.back().name = name;
  values.back().value = value;
}

Config integer(const std::string& name, int value) {
  Config config;
  add(config.ints, name, value);
  return config;
}

Config real(const std::string& name, double value) {
  Config config;
  add(config.doubles, name, value);
  return config;
}

Config text(const std::string& name, const std::string& value) {
  Config config;
  add(config.strs, name, value);
  return config;
}

class Reconfigure : public testing::Test {
 protected:
  // The answer.
  Config set(const std::string& nodelet, const Config& wanted) {
    dynamic_reconfigure::Reconfigure call;
    call.request.config = wanted;
    EXPECT_TRUE(ros::service::call(graph_.resolve(nodelet) + "/set_parameters", call));
    return call.response.config;
  }

  bool warnsOf(const std::string& part) {
    return log_.await(
               [&](const rosgraph_msgs::Log& log) {
                 return log.level == rosgraph_msgs::Log::WARN && log.msg.find(part) != std::string::npos;
               },
               kPatience_s) != nullptr;
  }

  ConfigDescription describe(const std::string& nodelet) {
    const Listener<ConfigDescription> descriptions(graph_.handle(), nodelet + "/parameter_descriptions");
    const auto description = descriptions.await([](const ConfigDescription&) { return true; }, kPatience_s);
    EXPECT_NE(description, nullptr);
    return description == nullptr ? ConfigDescription() : *description;
  }

  double onServer(const std::string& name) {
    double value = NAN;
    graph_.handle().getParam(name, value);
    return value;
  }

  NodeletGraph graph_{"reconfigure"};
  Listener<rosgraph_msgs::Log> log_{graph_.handle(), "/rosout"};
};

TEST_F(Reconfigure, StricterGateLosesTrackingAndTheOldOneFindsItAgain) {
  graph_.loadTracking();
  const Listener<TrackerStatus> tracker(graph_.handle(), "icp_tracking/status");
  FakeCamera camera(graph_.handle());
  ASSERT_TRUE(camera.awaitSubscribers());
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(3));
  const auto stateAfter = [&](const RgbdFrame& frame) {
    camera.publish(frame);
    const auto status = tracker.awaitStamp(camera.headerOf(frame).stamp);
    return status == nullptr ? -1 : static_cast<int>(status->state);
  };
  ASSERT_EQ(stateAfter(frames[0]), TrackerStatus::TRACKING);
  EXPECT_EQ(intOf(set("icp_tracking", integer("min_inliers", 10000000)), "min_inliers"), 10000000);
  EXPECT_EQ(stateAfter(frames[1]), TrackerStatus::LOST);
  EXPECT_EQ(intOf(set("icp_tracking", integer("min_inliers", 2000)), "min_inliers"), 2000);
  EXPECT_EQ(stateAfter(frames[2]), TrackerStatus::TRACKING);
}

TEST_F(Reconfigure, ChangesWhileFramesFlowAreTakenAndNoFrameIsLost) {
  graph_.loadTracking();
  const Listener<TrackerStatus> tracker(graph_.handle(), "icp_tracking/status");
  FakeCamera camera(graph_.handle());
  ASSERT_TRUE(camera.awaitSubscribers());
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(20));
  for (size_t i = 0; i < frames.size(); ++i) {
    camera.publish(frames[i]);
    const double sigma_px = 1.0 + 0.02 * static_cast<double>(i);
    const std::string nodelet = i % 2 == 0 ? "icp_tracking" : "tsdf_fusion";
    const std::string name = "preprocessing/bilateral_sigma_px";
    EXPECT_FLOAT_EQ(doubleOf(set(nodelet, real(name, sigma_px)), name), sigma_px);
    const auto status = tracker.awaitStamp(camera.headerOf(frames[i]).stamp);
    ASSERT_NE(status, nullptr);
    EXPECT_EQ(status->state, TrackerStatus::TRACKING) << status->reason;
  }
}

TEST_F(Reconfigure, ChangeIsPublishedAndOnTheParameterServer) {
  ASSERT_TRUE(graph_.load("icp_tracking"));
  const Listener<Config> updates(graph_.handle(), "icp_tracking/parameter_updates");
  ASSERT_TRUE(updates.awaitCount(1));
  EXPECT_FLOAT_EQ(onServer("icp_tracking/max_rmse_m"), 0.02);
  EXPECT_EQ(doubleOf(set("icp_tracking", real("max_rmse_m", 0.1)), "max_rmse_m"), 0.1);
  EXPECT_EQ(onServer("icp_tracking/max_rmse_m"), 0.1);
  EXPECT_TRUE(updates.await([](const Config& config) { return doubleOf(config, "max_rmse_m") == 0.1; }));
}

TEST_F(Reconfigure, ValueOutOfRangeIsRefusedAndTheOthersTaken) {
  ASSERT_TRUE(graph_.load("icp_tracking"));
  Config wanted = integer("min_inliers", 1);
  add(wanted.doubles, "max_rmse_m", 0.03);
  const Config answer = set("icp_tracking", wanted);
  EXPECT_EQ(intOf(answer, "min_inliers"), IcpTrackingParameters().min_inliers);
  EXPECT_EQ(doubleOf(answer, "max_rmse_m"), 0.03);
  EXPECT_TRUE(warnsOf("parameter 'min_inliers' is 1; it must lie in [6, 1e+08]"));
}

TEST_F(Reconfigure, WhatIsForTheStartOnlyStays) {
  ASSERT_TRUE(graph_.load("tsdf_fusion"));
  EXPECT_EQ(doubleOf(set("tsdf_fusion", real("map/voxel_size_m", 0.02)), "map/voxel_size_m"), 0.005);
  EXPECT_TRUE(warnsOf("parameter 'map/voxel_size_m' can be set at the start only; it stays 0.005"));
  EXPECT_EQ(textOf(set("tsdf_fusion", text("rule", "average")), "rule"), "kalman");
  EXPECT_TRUE(warnsOf("parameter 'rule' can be set at the start only"));
  EXPECT_EQ(onServer("map/voxel_size_m"), 0.005);
}

TEST_F(Reconfigure, UnknownNameIsWarnedOfWithTheNearest) {
  ASSERT_TRUE(graph_.load("icp_tracking"));
  const Config answer = set("icp_tracking", real("max_rmse", 0.03));
  EXPECT_TRUE(std::isnan(doubleOf(answer, "max_rmse")));
  EXPECT_TRUE(warnsOf("unknown parameter 'max_rmse'; did you mean 'max_rmse_m'?"));
}

TEST_F(Reconfigure, ValuesThatDoNotFitTogetherAreAllRefused) {
  ASSERT_TRUE(graph_.load("icp_tracking"));
  Config wanted = real("preprocessing/min_range_m", 3.0);
  add(wanted.doubles, "preprocessing/max_range_m", 2.0);
  const Config answer = set("icp_tracking", wanted);
  EXPECT_EQ(doubleOf(answer, "preprocessing/min_range_m"), 0.3);
  EXPECT_EQ(doubleOf(answer, "preprocessing/max_range_m"), 5.0);
  EXPECT_TRUE(warnsOf("min_range_m must be below"));
}

TEST_F(Reconfigure, NodeletsOfAStageInCommonFollow) {
  ASSERT_TRUE(graph_.load("icp_tracking"));
  ASSERT_TRUE(graph_.load("tsdf_fusion"));
  const Listener<Config> updates(graph_.handle(), "tsdf_fusion/parameter_updates");
  set("icp_tracking", real("preprocessing/max_range_m", 2.5));
  EXPECT_TRUE(updates.await(
      [](const Config& config) { return doubleOf(config, "preprocessing/max_range_m") == 2.5; }));
  EXPECT_EQ(doubleOf(set("tsdf_fusion", Config()), "preprocessing/max_range_m"), 2.5);
  EXPECT_EQ(onServer("preprocessing/max_range_m"), 2.5);
}

TEST_F(Reconfigure, ValuesLastUntilTheNodeletIsLoadedAgain) {
  ASSERT_TRUE(graph_.load("icp_tracking"));
  set("icp_tracking", real("max_rmse_m", 0.037));
  ASSERT_TRUE(graph_.unload("icp_tracking"));
  ASSERT_TRUE(graph_.load("icp_tracking"));
  EXPECT_EQ(doubleOf(set("icp_tracking", Config()), "max_rmse_m"), 0.037);
}

TEST_F(Reconfigure, WrongValueAtTheStartIsNamed) {
  graph_.handle().setParam("preprocessing/min_range_m", 6.0);
  EXPECT_FALSE(graph_.load("icp_tracking"));
}

TEST_F(Reconfigure, DescriptionsSayWhatTheTableSays) {
  ASSERT_TRUE(graph_.load("tsdf_fusion"));
  const ConfigDescription description = describe("tsdf_fusion");
  PipelineParameters stages;
  const std::vector<std::pair<std::string, ParameterTable>> tables = {
      {"Default", stages.tsdf_fusion.table()},
      {"map", withPrefix("map", stages.map.table())},
      {"preprocessing", withPrefix("preprocessing", stages.preprocessing.table())}};
  for (const auto& [name, table] : tables) {
    const auto* group = find(description.groups, name);
    ASSERT_NE(group, nullptr) << name;
    for (const Parameter& row : table) {
      const auto* described = find(group->parameters, row.name);
      ASSERT_NE(described, nullptr) << row.name;
      EXPECT_EQ(described->description, helpText(row) + (row.at_start_only ? " (at the start only)" : ""));
      EXPECT_EQ(described->edit_method.empty(), row.choices.empty()) << row.name;
      const auto* real_value = std::get_if<float*>(&row.value);
      if (real_value == nullptr) continue;
      EXPECT_EQ(described->type, "double");
      EXPECT_EQ(doubleOf(description.min, row.name), row.minimum);
      EXPECT_EQ(doubleOf(description.max, row.name), row.maximum);
      EXPECT_FLOAT_EQ(doubleOf(description.dflt, row.name), **real_value);
    }
  }
  EXPECT_EQ(find(description.groups[0].parameters, "picture")->edit_method,
            "{'enum': [{'name': 'shaded', 'type': 'str', 'value': 'shaded', 'description': 'shaded'}, "
            "{'name': 'colored', 'type': 'str', 'value': 'colored', 'description': 'colored'}], "
            "'enum_description': 'picture'}");
}

}  // namespace
}  // namespace depth_fusion
