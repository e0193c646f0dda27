#include "store/packed_row.h"

#include <gtest/gtest.h>

#include <random>

#include "support/expect_error.h"

namespace depth_fusion {
namespace {

std::string noise(size_t bytes) {
  std::mt19937 random(1);
  std::string text(bytes, '\0');
  for (char& byte : text) byte = static_cast<char>(random());
  return text;
}

TEST(PackedRow, ItComesBack) {
  for (const std::string& contents : {std::string(), std::string(100000, 'a'), noise(100000)})
    EXPECT_EQ(unpacked(packed(contents), "row"), contents);
  EXPECT_LT(packed(std::string(100000, 'a')).size(), 100u);
}

// zstd has a bit that says nothing.
TEST(PackedRow, AFlippedBitIsFoundOrChangesNothing) {
  const std::string contents = "some contents of a row " + noise(50), row = packed(contents);
  size_t found = 0;
  for (size_t bit = 0; bit < 8 * row.size(); ++bit) {
    std::string flipped = row;
    flipped[bit / 8] ^= static_cast<char>(1 << bit % 8);
    try {
      EXPECT_EQ(unpacked(flipped, "row"), contents) << bit;
    } catch (const Error&) {
      ++found;
    }
  }
  EXPECT_GE(found, 8 * row.size() - 1);
}

TEST(PackedRow, EveryCutIsFound) {
  const std::string row = packed(noise(300));
  for (size_t bytes = 0; bytes < row.size(); ++bytes)
    EXPECT_THROW(unpacked(row.substr(0, bytes), "row"), Error) << bytes;
  EXPECT_THROW(unpacked(row + "x", "row"), Error);
}

TEST(PackedRow, ARowThatPromisesTooMuchIsRefused) {
  // A frame's head of zstd: its magic number, eight bytes of content size, which say 2^40.
  const std::string head("\x28\xb5\x2f\xfd\xe0\0\0\0\0\0\1\0\0", 13);
  expectError([&] { unpacked(head, "row 7"); }, {"row 7", "damaged"});
}

}  // namespace
}  // namespace depth_fusion
