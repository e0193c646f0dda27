#include "texturing/texture_pages.h"

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "depth_fusion/common/error.h"

namespace depth_fusion {

std::string encodedPage(const cv::Mat& page) {
  std::vector<unsigned char> bytes;
  check(cv::imencode(".png", page, bytes), "a page of the texture cannot be encoded");
  return {bytes.begin(), bytes.end()};
}

std::vector<Eigen::Vector2f> sharesOf(const TexturedMesh& mesh) {
  std::vector<Eigen::Vector2f> shares(mesh.places.size());
  size_t face = 0;
  for (size_t page = 0; page < mesh.pages.size(); ++page) {
    const Eigen::Vector2f size(static_cast<float>(mesh.pages[page].cols),
                               static_cast<float>(mesh.pages[page].rows));
    for (; face < mesh.page_ends[page]; ++face) {
      for (const uint32_t vertex : mesh.mesh.triangles[face])
        shares[vertex] = (mesh.places[vertex].array() + 0.5f) / size.array();
    }
  }
  return shares;
}

PageFiles::PageFiles(const std::string& path, const std::vector<cv::Mat>& pages) {
  const std::string stem = std::filesystem::path(path).replace_extension().string();
  for (const cv::Mat& page : pages) {
    const std::string file = stem + "_" + std::to_string(names_.size()) + ".png";
    names_.push_back(std::filesystem::path(file).filename().string());
    files_.push_back(std::make_unique<WholeFile>(file));
    const std::string bytes = encodedPage(page);
    files_.back()->writeAt(0, bytes.data(), bytes.size());
  }
}

void PageFiles::commit() {
  for (const auto& file : files_) file->commit();
}

void GrowingFile::add(const std::string& bytes) {
  bytes_ += bytes;
  constexpr size_t kFlushBytes = size_t{1} << 20;
  if (bytes_.size() > kFlushBytes) flush();
}

void GrowingFile::commit() {
  flush();
  file_.commit();
}

void GrowingFile::flush() {
  file_.writeAt(offset_, bytes_.data(), bytes_.size());
  offset_ += bytes_.size();
  bytes_.clear();
}

}  // namespace depth_fusion
