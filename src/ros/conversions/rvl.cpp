#include "ros/conversions/rvl.h"

#include <cstdint>
#include <cstring>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr size_t kSizeBytes = 8;
constexpr uint32_t kMostPixels = 1u << 26;

// Numbers of three bits a nibble, of which the fourth says that more follow; eight nibbles a word, the first
// in its highest bits.
class NibbleReader {
 public:
  NibbleReader(const unsigned char* data, size_t size, const std::string& name)
      : data_(data), size_(size), name_(name) {}

  uint32_t number() {
    constexpr int kMostBits = 30;
    uint32_t value = 0;
    for (int bits = 0;; bits += 3) {
      const uint32_t nibble = nextNibble();
      value |= (nibble & 7u) << bits;
      if ((nibble & 8u) == 0) return value;
      check(bits < kMostBits, name_ + ": the image is corrupt");
    }
  }

 private:
  uint32_t nextNibble() {
    if (left_ == 0) {
      check(position_ + sizeof(word_) <= size_, name_ + ": the image is truncated; record it again");
      std::memcpy(&word_, data_ + position_, sizeof(word_));
      position_ += sizeof(word_);
      left_ = 8;
    }
    --left_;
    return word_ >> (4 * left_) & 15u;
  }

  const unsigned char* data_;
  const size_t size_;
  const std::string& name_;
  size_t position_ = 0;
  uint32_t word_ = 0;
  uint32_t left_ = 0;  // nibbles of the word
};

int32_t signedOf(uint32_t number) {
  return static_cast<int32_t>(number >> 1) ^ -static_cast<int32_t>(number & 1u);
}

}  // namespace

cv::Mat decodeRvl(const unsigned char* data, size_t size, const std::string& name) {
  uint32_t width = 0, height = 0;
  check(size > kSizeBytes, name + ": the compressed image is empty");
  std::memcpy(&width, data, sizeof(width));
  std::memcpy(&height, data + sizeof(width), sizeof(height));
  check(width > 0 && height > 0 && uint64_t{width} * height <= kMostPixels, name + ": the image is corrupt");
  cv::Mat image = cv::Mat::zeros(static_cast<int>(height), static_cast<int>(width), CV_16UC1);
  NibbleReader reader(data + kSizeBytes, size - kSizeBytes, name);
  uint16_t* pixel = image.ptr<uint16_t>();
  uint16_t value = 0;
  for (uint32_t left = width * height; left > 0;) {
    const uint32_t zeros = reader.number();
    check(zeros <= left, name + ": the image is corrupt");
    pixel += zeros;
    left -= zeros;
    if (left == 0) break;
    const uint32_t others = reader.number();
    check(others <= left && zeros + others > 0, name + ": the image is corrupt");
    for (uint32_t i = 0; i < others; ++i) {
      value = static_cast<uint16_t>(value + signedOf(reader.number()));
      *pixel++ = value;
    }
    left -= others;
  }
  return image;
}

}  // namespace depth_fusion
