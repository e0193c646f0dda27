#include "common/io/image_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "common/io/text_file.h"
#include "common/usual_size.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr unsigned char kPngSignature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr size_t kPngHeaderSize = 26;  // signature, length and type of IHDR, width, height, bits, kind

bool isJpeg(const unsigned char* data, size_t size) {
  return size >= 2 && data[0] == 0xff && data[1] == 0xd8;
}

uint32_t bigEndian32(const unsigned char* data) {
  return uint32_t{data[0]} << 24 | uint32_t{data[1]} << 16 | uint32_t{data[2]} << 8 | uint32_t{data[3]};
}

// Follows the chunks (length, type, data, checksum) to the last one, IEND.
bool pngIsComplete(const unsigned char* data, size_t size) {
  constexpr size_t kChunkFrame = 12;
  size_t position = sizeof(kPngSignature);
  while (position + kChunkFrame <= size) {
    if (std::memcmp(data + position + 4, "IEND", 4) == 0) return true;
    position += kChunkFrame + bigEndian32(data + position);
  }
  return false;
}

// The pixels after a start-of-scan marker (ff da) hold no marker until the end of the image (ff d9).
bool jpegIsComplete(const unsigned char* data, size_t size) {
  for (size_t i = size - 1; i > 0; --i) {
    if (data[i - 1] != 0xff) continue;
    if (data[i] == 0xd9) return true;
    if (data[i] == 0xda) return false;
  }
  return false;
}

bool isComplete(const unsigned char* data, size_t size) {
  if (beginsAsPng(data, size)) return pngIsComplete(data, size);
  if (isJpeg(data, size)) return jpegIsComplete(data, size);
  return true;
}

cv::Mat decode(const unsigned char* data, size_t size, int flags, const std::string& name) {
  check(size > 0, name + ": the image is empty");
  check(isComplete(data, size), name + ": the image is truncated; copy or record it again");
  cv::Mat image;
  try {
    image =
        cv::imdecode(cv::Mat(1, static_cast<int>(size), CV_8UC1, const_cast<unsigned char*>(data)), flags);
  } catch (const cv::Exception&) {
    image.release();
  }
  check(!image.empty(), name + ": the image is corrupt or of a kind that OpenCV does not read");
  return image;
}

Bytes bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  check(file.good(), path + ": cannot be read: " + std::strerror(errno));
  Bytes bytes(static_cast<size_t>(std::max<std::streamoff>(file.tellg(), 0)));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  check(file.good(), path + ": reading failed: " + std::strerror(errno));
  return bytes;
}

}  // namespace

bool beginsAsPng(const unsigned char* data, size_t size) {
  return size >= sizeof(kPngSignature) && std::memcmp(data, kPngSignature, sizeof(kPngSignature)) == 0;
}

cv::Mat decodeImage(const unsigned char* data, size_t size, const std::string& name) {
  return decode(data, size, cv::IMREAD_UNCHANGED, name);
}

cv::Mat decodeColorImage(const unsigned char* data, size_t size, const std::string& name) {
  return decode(data, size, cv::IMREAD_ANYCOLOR | cv::IMREAD_IGNORE_ORIENTATION, name);
}

cv::Mat readDepthImage(const std::string& path) {
  const Bytes bytes = bytesOf(path);
  cv::Mat depth = decodeImage(bytes.data(), bytes.size(), path);
  check(depth.type() == CV_16UC1, path + ": a depth image has one channel of 16 bits; this one has " +
                                      std::to_string(depth.channels()) + " of " +
                                      std::to_string(8 * depth.elemSize1()));
  return depth;
}

cv::Mat readColorImage(const std::string& path) {
  const Bytes bytes = bytesOf(path);
  return decodeColorImage(bytes.data(), bytes.size(), path);
}

std::optional<PngHeader> readPngHeader(const std::string& path) {
  constexpr unsigned char kGray = 0;
  std::ifstream file(path, std::ios::binary);
  unsigned char header[kPngHeaderSize];
  if (!file.read(reinterpret_cast<char*>(header), sizeof(header)) || !beginsAsPng(header, sizeof(header))) {
    return std::nullopt;
  }
  PngHeader read;
  read.size = {static_cast<int>(bigEndian32(header + 16)), static_cast<int>(bigEndian32(header + 20))};
  read.is_depth = header[24] == 16 && header[25] == kGray;
  return read;
}

cv::Size usualDepthSize(const std::vector<std::string>& paths, const std::string& list,
                        const std::string& remark) {
  constexpr size_t kSamples = 9;
  std::vector<cv::Size> sizes;
  std::string other;  // the first PNG that is no depth image
  bool is_any_depth = false;
  for (const std::string& path : paths) {
    if (sizes.size() >= kSamples && is_any_depth) break;
    const auto header = readPngHeader(path);
    if (!header || header->size.empty()) continue;
    if (sizes.size() < kSamples) sizes.push_back(header->size);
    if (!header->is_depth && other.empty()) other = path;
    is_any_depth = is_any_depth || header->is_depth;
  }
  const std::string none = list + ": none of its " + std::to_string(paths.size()) + " files ";
  check(!sizes.empty(), none + "is a PNG that can be read; the first is " + paths.front() + remark);
  check(is_any_depth,
        none + "has one channel of 16 bits, as depth has; the first that has not is " + other + remark);
  return usualSize(sizes);
}

void writePng(const std::string& path, const cv::Mat& image) {
  Bytes bytes;
  check(cv::imencode(".png", image, bytes), path + ": the image cannot be encoded as PNG");
  writeText(path, std::string(bytes.begin(), bytes.end()));
}

void writePicture(const std::string& path, const cv::Mat& picture) {
  bool written = false;
  try {
    written = cv::imwrite(path, picture);
  } catch (const cv::Exception&) {
    throw Error("picture " + path + ": OpenCV knows no picture format of this ending; use .png");
  }
  check(written, "picture " + path + " cannot be written; is its folder there and writable?");
}

}  // namespace depth_fusion
