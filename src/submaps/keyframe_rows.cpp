#include "submaps/keyframe_rows.h"

#include <cmath>
#include <cstring>
#include <utility>
#include <variant>

#include "store/packed_row.h"
#include "submaps/row_parts.h"

namespace depth_fusion {
namespace {

constexpr int kMaxLevels = 8;

void write(ByteWriter& bytes, DepthSensorParameters sensor) {
  for (const Parameter& row : sensor.table()) bytes.number(*std::get<float*>(row.value));
}

DepthSensorParameters readSensor(ByteReader& bytes) {
  DepthSensorParameters sensor;
  for (const Parameter& row : sensor.table()) *std::get<float*>(row.value) = bytes.number<float>();
  validate(sensor.table());
  return sensor;
}

void write(ByteWriter& bytes, const Feature& feature) {
  bytes.number(static_cast<uint8_t>(feature.level));
  bytes.number(static_cast<uint16_t>(feature.pixel.x));
  bytes.number(static_cast<uint16_t>(feature.pixel.y));
  bytes.bytes(feature.descriptor.data(), sizeof(feature.descriptor));
  bytes.bytes(feature.patch.data(), sizeof(feature.patch));
  bytes.number(static_cast<uint8_t>(feature.surface_C.has_value()));
  for (const double value : feature.surface_C.value_or(Eigen::Vector3d::Zero())) bytes.number(value);
}

constexpr size_t kFeatureBytes = 1 + 2 + 2 + sizeof(BriefDescriptor) + sizeof(FeaturePatch) + 1 + 3 * 8;

Feature readFeature(ByteReader& bytes) {
  Feature feature;
  feature.level = bytes.number<uint8_t>();
  feature.pixel.x = bytes.number<uint16_t>();
  feature.pixel.y = bytes.number<uint16_t>();
  std::memcpy(feature.descriptor.data(), bytes.bytes(sizeof(feature.descriptor)).data(),
              sizeof(feature.descriptor));
  std::memcpy(feature.patch.data(), bytes.bytes(sizeof(feature.patch)).data(), sizeof(feature.patch));
  const bool has_surface = bytes.number<uint8_t>() != 0;
  Eigen::Vector3d surface_C;
  for (double& value : surface_C) value = bytes.number<double>();
  if (has_surface) feature.surface_C = surface_C;
  check(feature.level < kMaxLevels && surface_C.allFinite(), bytes.where() + " has a feature that is none");
  return feature;
}

cv::Mat readThumbnail(ByteReader& bytes) {
  const int rows = bytes.number<int>(), columns = bytes.number<int>();
  check(rows == kThumbnailHeight_px && columns == kThumbnailWidth_px,
        bytes.where() + " has a thumbnail that is none");
  cv::Mat thumbnail(rows, columns, CV_32FC1);
  const std::string_view pixels = bytes.bytes(thumbnail.total() * sizeof(float));
  std::memcpy(thumbnail.data, pixels.data(), pixels.size());
  return thumbnail;
}

void writeLoopPart(ByteWriter& bytes, const Keyframe& keyframe) {
  bytes.number(keyframe.stamp_s);
  bytes.number(keyframe.way_m);
  bytes.text(keyframe.view.packed());
  if (!keyframe.view.isEmpty()) write(bytes, keyframe.view.camera());
  bytes.text(keyframe.color.jpeg);
  if (keyframe.color.jpeg.empty()) return;
  write(bytes, keyframe.color.camera);
  write(bytes, keyframe.color.T_C_D);
}

// Rows of format 2 end before it.
void readLoopPart(ByteReader& bytes, Keyframe& keyframe) {
  keyframe.stamp_s = bytes.number<double>();
  keyframe.way_m = bytes.number<double>();
  check(std::isfinite(keyframe.stamp_s) && std::isfinite(keyframe.way_m),
        bytes.where() + " has a time or a way that is none");
  std::string view = bytes.text();
  if (!view.empty()) keyframe.view = KeyframeView(readCamera(bytes), std::move(view), bytes.where());
  keyframe.color.jpeg = bytes.text();
  if (keyframe.color.jpeg.empty()) return;
  keyframe.color.camera = readCamera(bytes);
  keyframe.color.T_C_D = readPose(bytes);
}

}  // namespace

std::string keyframeRow(const Keyframe& keyframe) {
  const FrameFeatures& features = keyframe.features;
  ByteWriter bytes;
  write(bytes, keyframe.T_W_D);
  write(bytes, features.camera);
  write(bytes, features.T_C_D);
  write(bytes, features.depth_sensor);
  bytes.number(keyframe.thumbnail.rows);
  bytes.number(keyframe.thumbnail.cols);
  bytes.bytes(keyframe.thumbnail.data, keyframe.thumbnail.total() * sizeof(float));
  bytes.number(static_cast<uint32_t>(features.features.size()));
  for (const Feature& feature : features.features) write(bytes, feature);
  writeLoopPart(bytes, keyframe);
  return packed(bytes.take());
}

Keyframe parseKeyframe(const std::string& row, const std::string& where) {
  const std::string contents = unpacked(row, where);
  ByteReader bytes(contents, where);
  Keyframe keyframe;
  keyframe.T_W_D = readPose(bytes);
  keyframe.features.camera = readCamera(bytes);
  keyframe.features.T_C_D = readPose(bytes);
  keyframe.features.depth_sensor = readSensor(bytes);
  keyframe.thumbnail = readThumbnail(bytes);
  for (size_t i = readCount(bytes, kFeatureBytes); i > 0; --i)
    keyframe.features.features.push_back(readFeature(bytes));
  if (bytes.left() > 0) readLoopPart(bytes, keyframe);
  checkAtEnd(bytes);
  return keyframe;
}

}  // namespace depth_fusion
