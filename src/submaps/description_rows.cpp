#include "submaps/description_rows.h"

#include "depth_fusion/map/map_parameters.h"
#include "store/packed_row.h"
#include "submaps/row_keys.h"
#include "submaps/row_parts.h"

namespace depth_fusion {
namespace {

// Changes with what is in any of a map's rows. Format 3 has what loops are closed by in keyframes' rows.
constexpr uint32_t kVersion = 3;
constexpr uint32_t kOldestVersion = 2;  // that is read
constexpr char kMagic[] = "depth_fusion map";

void writeTexts(ByteWriter& bytes, const std::vector<std::string>& texts) {
  bytes.number(static_cast<uint32_t>(texts.size()));
  for (const std::string& text : texts) bytes.text(text);
}

std::vector<std::string> readTexts(ByteReader& bytes) {
  std::vector<std::string> texts(readCount(bytes, sizeof(uint32_t)));
  for (std::string& text : texts) text = bytes.text();
  return texts;
}

void checkVersion(uint32_t version, const std::string& software, const std::string& where) {
  check(version >= kOldestVersion && version <= kVersion,
        where + " is of format " + std::to_string(version) + ", written by " + software +
            "; this program reads formats " + std::to_string(kOldestVersion) + " to " +
            std::to_string(kVersion) + (version > kVersion ? "; take a newer one" : ""));
}

}  // namespace

const std::string& MapDescription::parameter(const std::string& name) const {
  for (const auto& [key, value] : parameters) {
    if (key == name) return value;
  }
  throw Error("the map says nothing of " + name);
}

void checkSameParameter(const MapDescription& stored, const std::string& parameter,
                        const ParameterTable& present, const std::string& name) {
  const std::string& theirs = stored.parameter(parameter);
  const std::string ours = valueText(findParameter(present, parameter));
  check(theirs == ours, name + " was made with " + parameter + " " + theirs + ", and this map has " + ours +
                            "; set it to " + theirs);
}

std::string descriptionRow(const MapDescription& description) {
  ByteWriter bytes;
  bytes.text(kMagic);
  bytes.number(kVersion);
  bytes.text(description.software);
  bytes.number(description.id);
  bytes.number(description.revision);
  bytes.number(description.saved_at_s);
  bytes.number(static_cast<uint32_t>(description.parameters.size()));
  for (const auto& [name, value] : description.parameters) {
    bytes.text(name);
    bytes.text(value);
  }
  write(bytes, description.camera);
  bytes.number(description.last_pose.stamp_s);
  write(bytes, description.last_pose.T_W_D);
  bytes.number(description.way_m);
  bytes.number(description.active_submap);
  writeTexts(bytes, description.layers);
  return packed(bytes.take());
}

MapDescription parseDescription(const std::string& row, const std::string& where) {
  const std::string contents = unpacked(row, where);
  ByteReader bytes(contents, where);
  check(bytes.text() == kMagic, where + " is not that of a map of depth_fusion");
  const auto version = bytes.number<uint32_t>();
  MapDescription description;
  description.software = bytes.text();
  checkVersion(version, description.software, where);
  description.id = bytes.number<uint64_t>();
  description.revision = bytes.number<uint64_t>();
  description.saved_at_s = bytes.number<double>();
  for (size_t i = readCount(bytes, 2 * sizeof(uint32_t)); i > 0; --i) {
    std::string name = bytes.text();
    description.parameters.emplace_back(std::move(name), bytes.text());
  }
  description.camera = readCamera(bytes);
  description.last_pose.stamp_s = bytes.number<double>();
  description.last_pose.T_W_D = readPose(bytes);
  description.way_m = bytes.number<double>();
  description.active_submap = bytes.number<uint32_t>();
  description.layers = readTexts(bytes);
  checkAtEnd(bytes);
  return description;
}

std::string submapRow(const SubmapDescription& submap) {
  ByteWriter bytes;
  bytes.number(submap.id);
  write(bytes, submap.T_W_S);
  for (const int i : submap.window.origin) bytes.number(i);
  bytes.number(submap.window.blocks_per_axis);
  bytes.number(submap.blocks);
  bytes.number(submap.left_at_m);
  return packed(bytes.take());
}

SubmapDescription parseSubmap(const std::string& row, const std::string& where) {
  const std::string contents = unpacked(row, where);
  ByteReader bytes(contents, where);
  SubmapDescription submap;
  submap.id = bytes.number<uint32_t>();
  submap.T_W_S = readPose(bytes);
  for (int& i : submap.window.origin) i = bytes.number<int>();
  submap.window.blocks_per_axis = bytes.number<int>();
  submap.blocks = bytes.number<uint64_t>();
  submap.left_at_m = bytes.number<double>();
  checkAtEnd(bytes);
  checkBlock(submap.window.origin);
  MapParameters map;
  map.blocks_per_axis = submap.window.blocks_per_axis;
  validate(map.table());
  return submap;
}

}  // namespace depth_fusion
