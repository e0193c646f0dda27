// Every member of the parameters of input, output and nodelets has a row.
#include <gtest/gtest.h>

#include "ros/in_process/live_tracker_parameters.h"
#include "ros/input/device_publisher_parameters.h"
#include "ros/input/player_parameters.h"
#include "ros/input/rgbd_parameters.h"
#include "ros/nodelets/icp_tracking_nodelet_parameters.h"
#include "ros/nodelets/navigation_nodelet_parameters.h"
#include "ros/nodelets/surface_mesh_nodelet_parameters.h"
#include "ros/nodelets/tsdf_fusion_nodelet_parameters.h"
#include "ros/output/live_surface_parameters.h"
#include "ros/output/map_keeper_parameters.h"
#include "ros/output/map_refiner_parameters.h"
#include "ros/output/model_picture_parameters.h"
#include "ros/output/pose_parameters.h"
#include "support/parameter_rows.h"

namespace depth_fusion {
namespace {

// Its own members, those of the pairing, and none of registration and masking, which have tables of their
// own.
constexpr size_t rgbdRows() { return fieldCount<RgbdParameters>() - 3 + fieldCount<PairingParameters>(); }

// The camera and its settings, of which one lies in the other.
constexpr size_t deviceRows() { return fieldCount<DeviceParameters>() - 1 + fieldCount<CameraSettings>(); }

TEST(ParameterRows, EveryMemberOfTheOutputsHasOne) {
  expectRows<PoseParameters>();
  expectRows<LiveSurfaceParameters>();
  expectRows<ModelPictureParameters>();
  expectRows<MapKeeperParameters>();
  expectRows<MapRefinerParameters>();
}

TEST(ParameterRows, EveryMemberOfTheInputsHasOne) {
  expectRows<PlayerParameters>();
  expectRows<DeviceTimeParameters>();
  expectRows<DevicePublisherParameters>(fieldCount<DevicePublisherParameters>() - 2 + deviceRows() +
                                        fieldCount<DeviceTimeParameters>());
  expectRows<RgbdParameters>(rgbdRows());
}

TEST(ParameterRows, EveryMemberOfTheNodeletsHasOne) {
  // Without the pipeline, the stages of which have tables of their own.
  expectRows<LiveTrackerParameters>(fieldCount<LiveTrackerParameters>() - 1);
  expectRows<IcpTrackingNodeletParameters>(
      fieldCount<IcpTrackingNodeletParameters>() - 3 + fieldCount<IcpTrackingParameters>() + rgbdRows() +
      fieldCount<PoseParameters>() + fieldCount<LiveTrackerParameters>() - 1);
  expectRows<TsdfFusionNodeletParameters>(
      fieldCount<TsdfFusionNodeletParameters>() - 5 + fieldCount<TsdfFusionParameters>() + rgbdRows() +
      fieldCount<ModelPictureParameters>() + fieldCount<MapKeeperParameters>() +
      fieldCount<MapRefinerParameters>());
  expectRows<SurfaceMeshNodeletParameters>(fieldCount<SurfaceMeshNodeletParameters>() - 3 +
                                           fieldCount<SurfaceMeshParameters>() +
                                           fieldCount<LiveSurfaceParameters>());
  expectRows<NavigationNodeletParameters>(fieldCount<NavigationNodeletParameters>() - 2 +
                                          fieldCount<NavigationParameters>() - 1 +
                                          fieldCount<FloorGridParameters>());
}

// A nodelet takes the pipeline's stages by their names, bound to its own parameters.
template <class NodeletParameters>
void expectStagesOfThePipeline() {
  NodeletParameters parameters;
  PipelineParameters pipeline;
  const ParameterTable known = pipeline.table();
  for (const auto& [stage, table] : parameters.stages()) {
    if (stage == "masking") continue;  // which comes before the pipeline
    for (const Parameter& row : withPrefix(stage, table)) EXPECT_NO_THROW(findParameter(known, row.name));
    expectWithin(parameters, table);
  }
}

TEST(ParameterRows, TheStagesOfTheNodeletsAreThePipelines) {
  expectStagesOfThePipeline<IcpTrackingNodeletParameters>();
  expectStagesOfThePipeline<TsdfFusionNodeletParameters>();
}

}  // namespace
}  // namespace depth_fusion
