#include "submaps/row_keys.h"

#include <cctype>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

// A number as a text of four bytes; texts are ordered as the numbers are.
std::string ordered(uint32_t number) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(number >> shift & 0xffu);
  return text;
}

constexpr uint32_t kSignBit = 0x80000000u;

std::string ordered(int number) { return ordered(static_cast<uint32_t>(number) ^ kSignBit); }

uint32_t numberAt(const std::string& text, size_t begin) {
  uint32_t number = 0;
  for (size_t i = begin; i < begin + 4; ++i) number = number << 8 | static_cast<uint8_t>(text.at(i));
  return number;
}

int orderedNumber(const std::string& text, size_t begin) {
  return static_cast<int>(numberAt(text, begin) ^ kSignBit);
}

}  // namespace

std::string submapKey(uint32_t submap) { return kSubmapPrefix + ordered(submap); }

std::string keyframePrefix(uint32_t submap) { return "keyframe/" + ordered(submap); }

std::string keyframeKey(uint32_t submap, uint32_t number) { return keyframePrefix(submap) + ordered(number); }

std::string blocksPrefix(uint32_t submap, const std::string& layer) {
  return "blocks/" + ordered(submap) + "/" + layer + "/";
}

std::string blocksKey(uint32_t submap, const std::string& layer, const BlockIndex& group) {
  return blocksPrefix(submap, layer) + ordered(group.z()) + ordered(group.y()) + ordered(group.x());
}

BlockIndex groupOfKey(const std::string& key, const std::string& prefix) {
  check(key.size() == prefix.size() + 12, "the map has a row of blocks without a place");
  const size_t begin = prefix.size();
  BlockIndex group(orderedNumber(key, begin + 8), orderedNumber(key, begin + 4), orderedNumber(key, begin));
  checkBlock(group);
  return group;
}

void checkBlock(const BlockIndex& block) {
  constexpr int kFarthest = 1 << 26;
  check((block.array() > -kFarthest).all() && (block.array() < kFarthest).all(),
        "the map has a block that is out of all bounds");
}

uint32_t numberOfKey(const std::string& key) {
  check(key.size() >= 4, "the map has a row without a number");
  return numberAt(key, key.size() - 4);
}

std::string readable(const std::string& key) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const char c : key) {
    if (std::isprint(static_cast<unsigned char>(c)) != 0) {
      text += c;
    } else {
      text += std::string("%") + kDigits[static_cast<unsigned char>(c) >> 4] + kDigits[c & 0xf];
    }
  }
  return text;
}

}  // namespace depth_fusion
