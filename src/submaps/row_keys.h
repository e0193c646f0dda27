// What the rows of a map are called in a database.
#pragma once

#include <cstdint>
#include <string>

#include "depth_fusion/map/block_index.h"

namespace depth_fusion {

// Keys of one kind begin with the same prefix, and are ordered as what they name.
constexpr char kDescriptionKey[] = "description";
constexpr char kSubmapPrefix[] = "submap/";
std::string submapKey(uint32_t submap);
std::string keyframePrefix(uint32_t submap);
std::string keyframeKey(uint32_t submap, uint32_t number);
std::string blocksPrefix(uint32_t submap, const std::string& layer);
std::string blocksKey(uint32_t submap, const std::string& layer, const BlockIndex& group);

// The group that a key of blocksKey names. Throws Error for another one.
BlockIndex groupOfKey(const std::string& key, const std::string& prefix);

// Throws Error for a block that is so far away that numbers overflow.
void checkBlock(const BlockIndex& block);

// The last number of a key, of a keyframe for instance.
uint32_t numberOfKey(const std::string& key);

// A key for messages.
std::string readable(const std::string& key);

}  // namespace depth_fusion
