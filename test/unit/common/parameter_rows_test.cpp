// Every member of a struct of parameters has a row of its own.
#include "support/parameter_rows.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "depth_fusion/acquisition/device_parameters.h"
#include "depth_fusion/esdf/esdf_parameters.h"
#include "depth_fusion/esdf/floor_grid_parameters.h"
#include "depth_fusion/loops/loop_parameters.h"
#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "depth_fusion/texturing/texturing_parameters.h"

namespace depth_fusion {
namespace {

TEST(FieldCount, CountsMembersOfEveryKind) {
  struct Inner {
    int a = 0, b = 0;
  };
  struct Outer {
    bool flag = false;
    float number = 0.0f;
    std::string text;
    Inner inner;
  };
  struct Empty {};
  EXPECT_EQ(fieldCount<Empty>(), 0u);
  EXPECT_EQ(fieldCount<Inner>(), 2u);
  EXPECT_EQ(fieldCount<Outer>(), 4u);
}

TEST(ParameterRows, EveryMemberOfAStageHasOne) {
  expectRows<MapParameters>();
  expectRows<SubmapParameters>();
  expectRows<RegistrationParameters>();
  expectRows<DepthSensorParameters>();
  expectRows<PreprocessingParameters>();
  expectRows<TextureOdometryParameters>();
  expectRows<IcpTrackingParameters>();
  expectRows<RelocalisationParameters>();
  expectRows<LoopParameters>();
  expectRows<TsdfFusionParameters>();
  expectRows<ColorFusionParameters>();
  expectRows<ModelViewParameters>();
  expectRows<SurfaceMeshParameters>();
  expectRows<TexturingParameters>();
  expectRows<EsdfParameters>();
  expectRows<FloorGridParameters>();
}

TEST(ParameterRows, EveryMemberOfACameraHasOne) {
  expectRows<CameraSettings>();
  expectRows<DeviceParameters>(fieldCount<DeviceParameters>() - 1 + fieldCount<CameraSettings>());
}

TEST(ParameterRows, EveryStageOfThePipelineHasItsOwn) {
  PipelineParameters parameters;
  std::set<std::string> stages, names;
  for (const Parameter& row : parameters.table()) {
    stages.insert(row.name.substr(0, row.name.find('/')));
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
  }
  EXPECT_EQ(stages.size(), fieldCount<PipelineParameters>());
}

// Whoever reads a table from its top finds first what is worth a try.
TEST(ParameterRows, ExpertsStandBehindTheOthers) {
  PipelineParameters parameters;
  for (const ParameterTable& table : {parameters.icp_tracking.table(), parameters.texture_odometry.table()}) {
    size_t usual = 0;
    while (usual < table.size() && !table[usual].is_expert) ++usual;
    EXPECT_EQ(usual, 5u);
    for (size_t i = usual; i < table.size(); ++i) EXPECT_TRUE(table[i].is_expert) << table[i].name;
    EXPECT_EQ(helpText(table.back()), table.back().help + " (expert)");
    EXPECT_EQ(helpText(table.front()), table.front().help);
  }
}

// What a name stands for is never guessed.
TEST(Enumeration, HasOneListOfNames) {
  const Enumeration<int> shapes = {{"round", 1}, {"square", 4}};
  EXPECT_EQ(shapes.of("square"), 4);
  EXPECT_EQ(shapes.names(), (std::vector<std::string>{"round", "square"}));
  EXPECT_THROW(shapes.of("oval"), Error);
  std::string kind = "oval";
  EXPECT_THROW(validate({choice("kind", &kind, shapes, "the shape")}), Error);
  EXPECT_EQ(renderers().of(ModelViewParameters().renderer), Renderer::kRayCasting);
}

}  // namespace
}  // namespace depth_fusion
