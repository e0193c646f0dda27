// The container of binary glTF 2.0: a text that describes what is in the bytes behind it.
#pragma once

#include <array>
#include <string>

#include "depth_fusion/surface_mesh/mesh_file.h"
#include "surface_mesh/whole_file.h"

namespace depth_fusion {

// A piece of the bytes, and how many numbers, pairs, triples or quadruples it holds.
struct GlbPart {
  uint64_t offset = 0, bytes = 0, count = 0;
};

// The description is written last, so that it can tell what only the end is known of; room is kept for it.
class GlbFile {
 public:
  // Throws Error if the file cannot be created.
  explicit GlbFile(const std::string& path) : path_(path), file_(path) {}

  // The description will have up to text_bytes bytes. Throws Error if there are more than a file can hold,
  // which is 4 GiB.
  void begin(uint64_t text_bytes, uint64_t data_bytes);
  void write(uint64_t offset, const void* data, size_t bytes);
  void finish(std::string text);

 private:
  std::string path_;
  WholeFile file_;
  uint64_t text_bytes_ = 0, data_bytes_ = 0;
};

// These are members of the description. glTF's frame has y up, and z towards the viewer.
std::string glbHead(UpAxis up);
std::string glbBuffer(uint64_t bytes);
// `target` is glTF's number of what the part is for; 0: none.
std::string glbView(const GlbPart& part, int target);
std::string glbAccessor(int view, uint64_t count, int component, const char* type,
                        const std::string& more = "");
// The smallest box with all the positions, as the accessor of positions must tell it.
std::string glbBounds(const Eigen::AlignedBox3f& box);

constexpr int kGlbVertexData = 34962, kGlbIndexData = 34963;
constexpr int kGlbUint16 = 5123, kGlbUint32 = 5125, kGlbFloat = 5126;

// glTF's vertex colours are linear in the light, those of pictures are not.
std::array<uint16_t, 4> linearColor(const MeshColor& color);

}  // namespace depth_fusion
