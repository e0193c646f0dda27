// The pages of a texture in files, and where vertices lie in them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/texturing/textured_mesh.h"
#include "surface_mesh/whole_file.h"

namespace depth_fusion {

// The page as a PNG file has it.
std::string encodedPage(const cv::Mat& page);

// The places of all vertices as shares of their pages, from the top left corner on.
std::vector<Eigen::Vector2f> sharesOf(const TexturedMesh& mesh);

// Pages as files beside a mesh.
class PageFiles {
 public:
  // Writes PATH without its ending and with _0.png, _1.png, ... in its place. Throws Error if it cannot.
  PageFiles(const std::string& path, const std::vector<cv::Mat>& pages);

  // Without their folder.
  const std::vector<std::string>& names() const { return names_; }
  // Until then nothing is seen of them. Throws Error.
  void commit();

 private:
  std::vector<std::string> names_;
  std::vector<std::unique_ptr<WholeFile>> files_;
};

// A file that is written piece after piece, and appears with commit().
class GrowingFile {
 public:
  explicit GrowingFile(const std::string& path) : file_(path) {}
  void add(const std::string& bytes);
  // As printf, a line at most.
  template <class... Values>
  void print(const char* format, Values... values) {
    char line[256];
    add({line, static_cast<size_t>(std::snprintf(line, sizeof(line), format, values...))});
  }
  void commit();

 private:
  void flush();

  WholeFile file_;
  std::string bytes_;
  uint64_t offset_ = 0;
};

}  // namespace depth_fusion
