#include "depth_fusion/color_fusion/color_fusion.h"

#include <gtest/gtest.h>

#include <cstring>
#include <opencv2/imgproc.hpp>

#include "depth_fusion/common/percentile.h"
#include "depth_fusion/compute/device_image.h"
#include "support/colored_scene.h"
#include "support/expect_error.h"

namespace depth_fusion {
namespace {

constexpr int kFrames = 8;

double meanError(const TriangleMesh& mesh) {
  return ColorErrors::mean(colorErrors(mesh, coloredScene()).all);
}

TEST(ColorFusion, VertexColorsAreTheTextures) {
  const TriangleMesh mesh = fuseFrames(colorParameters(), kFrames);
  ASSERT_EQ(mesh.colors.size(), mesh.vertices.size());
  ColorErrors errors = colorErrors(mesh, coloredScene());
  ASSERT_GT(errors.all.size(), 10000u);
  EXPECT_LT(ColorErrors::mean(errors.all), 1.5);
  EXPECT_LT(percentile(errors.all, 0.95), 4.0);
  EXPECT_LT(errors.unknown, mesh.vertices.size() / 200);
}

TEST(ColorFusion, WithoutColorNothingIsAllocatedAndTheMeshIsTheSame) {
  PipelineParameters parameters = colorParameters();
  const TriangleMesh colored = fuseFrames(parameters, 3);
  parameters.map.color = false;
  const TriangleMesh plain = fuseFrames(parameters, 3);
  EXPECT_TRUE(plain.colors.empty());
  EXPECT_EQ(plain.triangles, colored.triangles);
  ASSERT_EQ(plain.vertices.size(), colored.vertices.size());
  EXPECT_EQ(
      std::memcmp(plain.vertices.data(), colored.vertices.data(), plain.vertices.size() * sizeof(MeshVertex)),
      0);
  BlockMap map(compute(), parameters.map);
  EXPECT_FALSE(map.hasLayer(kColorLayer));
  EXPECT_EQ(map.usage().bytesOf(kColorLayer), 0u);
}

TEST(ColorFusion, MapSaysWhatColorCosts) {
  MapParameters parameters = colorParameters().map;
  BlockMap map(compute(), parameters);
  map.allocate({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(map.usage().bytesOf(kColorLayer), 3u * 512 * 4);
  EXPECT_EQ(map.usage().bytes, 3u * 512 * 6 + 4 * 64 * 64 * 64);
  EXPECT_EQ(map.layer(kColorLayer).bytes(), 2 * map.layer(kTsdfLayer).bytes());
  parameters.color = false;
  EXPECT_EQ(BlockMap(compute(), parameters).usage().pool_bytes + map.layer(kColorLayer).bytes(),
            map.usage().pool_bytes);
}

// Exposure falls by a third and white balance drifts while the camera pans from left to right.
TEST(ColorFusion, ExposureDriftLeavesNoTrace) {
  constexpr int kPan = 16;
  const auto pose = [](int i) {
    return motionOf({0.0, -14.0 + 28.0 * i / (kPan - 1), 0.0}, {0.02 * i - 0.15, 0.0, 0.0});
  };
  const auto drift = [](int i, RgbdFrame& frame) {
    const double t = i / (kPan - 1.0);
    frame.color = scaledColor(frame.color, cv::Scalar(1.0 - 0.25 * t, 1.0 - 0.33 * t, 1.0 - 0.4 * t));
  };
  PipelineParameters parameters = colorParameters();
  const ColorErrors matched = colorErrors(fuseFrames(parameters, kPan, drift, pose), coloredScene());
  ASSERT_GT(matched.left.size(), 2000u);
  ASSERT_GT(matched.right.size(), 2000u);
  EXPECT_LT(ColorErrors::mean(matched.left), 3.0);
  EXPECT_LT(ColorErrors::mean(matched.right), 4.0);
  parameters.color_fusion.match_exposure = false;
  const ColorErrors unmatched = colorErrors(fuseFrames(parameters, kPan, drift, pose), coloredScene());
  EXPECT_GT(ColorErrors::mean(unmatched.right), 12.0) << "the test does not show what matching is for";
}

TEST(ColorFusion, ColorCameraMayStandBesideTheDepthCamera) {
  const CameraIntrinsics color_camera{400, 300, 300.0, 305.0, 207.0, 146.0};
  const Pose T_C_D = motionOf({0.8, -1.0, 1.5}, {-0.05, 0.01, 0.004});
  PipelineParameters parameters = colorParameters();
  parameters.color_fusion.align = false;
  const auto beside = [&](int i, RgbdFrame& frame) {
    frame.color = render(coloredScene(), color_camera, swayingPose(i) * T_C_D.inverse()).color;
    frame.color_intrinsics = color_camera;
    frame.T_C_D = T_C_D;
  };
  EXPECT_LT(meanError(fuseFrames(parameters, kFrames, beside)), 2.0);
  const auto forgotten = [&](int i, RgbdFrame& frame) {
    beside(i, frame);
    frame.T_C_D = std::nullopt;
  };
  EXPECT_GT(meanError(fuseFrames(parameters, kFrames, forgotten)), 6.0);
}

// Colour taken a moment after the depth, of a hand that moves.
TEST(ColorFusion, AlignmentMakesUpForClocksThatDiffer) {
  const auto late = [](int i, RgbdFrame& frame) {
    if (i == 0) return;
    const Pose moved = motionOf({1.0 * std::cos(2.0 * i), 1.0 * std::sin(3.0 * i), 0.5 * std::cos(i)},
                                {0.01 * std::sin(2.5 * i), 0.01 * std::cos(1.5 * i), 0.0});
    frame.color = render(coloredScene(), kColorTestCamera, swayingPose(i) * moved).color;
  };
  PipelineParameters parameters = colorParameters();
  const double aligned = meanError(fuseFrames(parameters, kFrames, late));
  parameters.color_fusion.align = false;
  const double unaligned = meanError(fuseFrames(parameters, kFrames, late));
  EXPECT_LT(aligned, 2.5);
  EXPECT_GT(unaligned, 2.0 * aligned);
}

// Every other image is blurred, as by a fast motion.
TEST(ColorFusion, SharpImagesCountMoreThanBlurredOnes) {
  const auto blur = [](int i, RgbdFrame& frame) {
    if (i % 2 == 1) cv::blur(frame.color, frame.color, cv::Size(41, 1));
  };
  PipelineParameters parameters = colorParameters();
  const double weighted = meanError(fuseFrames(parameters, kFrames, blur));
  parameters.color_fusion.blur_exponent = 0.0f;
  const double alike = meanError(fuseFrames(parameters, kFrames, blur));
  EXPECT_LT(1.5 * weighted, alike);
}

// The colour camera sees the box three pixels beside where the depth camera does; no colour may spill over
// its edges.
TEST(ColorFusion, ColorsDoNotSpillOverDepthEdges) {
  const auto shifted = [](int, RgbdFrame& frame) {
    const cv::Mat shift = (cv::Mat_<double>(2, 3) << 1, 0, 3, 0, 1, 0);
    cv::warpAffine(frame.color, frame.color, shift, frame.color.size(), cv::INTER_LINEAR,
                   cv::BORDER_REPLICATE);
  };
  PipelineParameters parameters = colorParameters();
  parameters.color_fusion.align = false;
  const auto spilled = [](const TriangleMesh& mesh) {
    const Primitive& box = coloredScene().primitives()[1];
    size_t count = 0;
    for (size_t i = 0; i < mesh.vertices.size(); ++i) {
      const bool on_wall = box.distance(mesh.vertices[i].position_W.cast<double>()) > 0.1;
      const bool is_reddish = mesh.colors[i][0] > mesh.colors[i][2] + 10;
      count += on_wall && is_reddish;
    }
    return count;
  };
  const size_t with_edges = spilled(fuseFrames(parameters, kFrames, shifted));
  parameters.color_fusion.max_relative_step = 1.0f;
  const size_t without_edges = spilled(fuseFrames(parameters, kFrames, shifted));
  EXPECT_GT(without_edges, 100u);
  EXPECT_LT(2 * with_edges, without_edges);
}

TEST(ColorFusion, GreyImagesGiveGreyVertices) {
  const auto to_grey = [](int, RgbdFrame& frame) {
    cv::Mat grey;
    cv::cvtColor(frame.color, grey, cv::COLOR_BGR2GRAY);
    frame.color = grey;
  };
  const TriangleMesh mesh = fuseFrames(colorParameters(), 2, to_grey);
  ASSERT_FALSE(mesh.colors.empty());
  int darkest = 255, brightest = 0;
  for (const MeshColor& color : mesh.colors) {
    ASSERT_TRUE(color[0] == color[1] && color[1] == color[2]);
    darkest = std::min<int>(darkest, color[0]);
    brightest = std::max<int>(brightest, color[0]);
  }
  EXPECT_GT(brightest - darkest, 60);
}

TEST(ColorFusion, FramesWithoutFittingColorSayWhyAndChangeNothing) {
  ReconstructionPipeline pipeline(compute(), colorParameters(), kColorTestCamera);
  RgbdFrame frame = exactFrame(coloredScene(), swayingPose(0));
  EXPECT_TRUE(pipeline.processFrame(frame, swayingPose(0)).color.fused);
  const std::vector<uint32_t> before =
      pipeline.map().layer(kColorLayer).read<uint32_t>(512 * pipeline.map().slots().bound());
  frame.color = frame.color.rowRange(0, 100).clone();
  ColorFusionResult result = pipeline.processFrame(frame, swayingPose(0)).color;
  EXPECT_FALSE(result.fused);
  EXPECT_NE(result.reason.find("320x100"), std::string::npos) << result.reason;
  frame.color.release();
  result = pipeline.processFrame(frame, swayingPose(0)).color;
  EXPECT_FALSE(result.fused);
  EXPECT_EQ(result.reason, "no colour image");
  EXPECT_EQ(pipeline.map().layer(kColorLayer).read<uint32_t>(before.size()), before);
}

// The view from which a frame was fused looks like its image.
TEST(ColorFusion, ModelViewsShowColorsAndShades) {
  ReconstructionPipeline pipeline(compute(), colorParameters(), kColorTestCamera);
  const RgbdFrame frame = exactFrame(coloredScene(), swayingPose(0));
  pipeline.processFrame(frame, swayingPose(0));
  ModelViewRenderer renderer(compute(), pipeline.map(), kColorTestCamera);
  const ModelView& view = renderer.render(swayingPose(0), 0.3f, 5.0f, pipeline.timers());
  cv::Mat seen = readImage(view.depth, kColorTestCamera) > 0.0f;
  cv::Mat edges;
  cv::morphologyEx(frame.depth, edges, cv::MORPH_GRADIENT, cv::Mat::ones(7, 7, CV_8U));
  const cv::Mat compared = seen & (edges < 0.05f);
  ASSERT_GT(cv::countNonZero(compared), kColorTestCamera.width * kColorTestCamera.height / 2);
  cv::Mat difference;
  cv::absdiff(renderer.coloredPicture(), frame.color, difference);
  const cv::Scalar mean = cv::mean(difference, compared);
  for (int channel = 0; channel < 3; ++channel) EXPECT_LT(mean[channel], 2.0);

  const cv::Mat shaded = renderer.shadedPicture();
  const cv::Vec3b middle_of_wall = shaded.at<cv::Vec3b>(120, 90);
  EXPECT_GT(middle_of_wall[0], 200);
  EXPECT_LT(cv::norm(shaded.at<cv::Vec3b>(120, 90), shaded.at<cv::Vec3b>(100, 95)), 12.0)
      << "the texture shows";
}

TEST(ColorFusion, MapWithoutColorIsAnError) {
  MapParameters parameters = colorParameters().map;
  parameters.color = false;
  BlockMap map(compute(), parameters);
  expectError([&] { ColorFusion(compute(), map, {}); }, {"map/color"});
  ModelViewRenderer renderer(compute(), map, kColorTestCamera);
  expectError([&] { renderer.coloredPicture(); }, {"map/color"});
}

TEST(ColorFusion, ReusedBlocksForgetTheirColor) {
  ReconstructionPipeline pipeline(compute(), colorParameters(), kColorTestCamera);
  pipeline.processFrame(exactFrame(coloredScene(), swayingPose(0)), swayingPose(0));
  ASSERT_GT(pipeline.map().usage().blocks, 100u);
  pipeline.map().reset(Eigen::Vector3d::Zero());
  pipeline.map().allocate({{0, 0, 0}, {1, 0, 0}});
  const std::vector<uint32_t> colors = pipeline.map().layer(kColorLayer).read<uint32_t>(2 * 512);
  EXPECT_EQ(colors, std::vector<uint32_t>(colors.size(), 0));
}

}  // namespace
}  // namespace depth_fusion
