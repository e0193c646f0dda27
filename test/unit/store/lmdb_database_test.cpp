// Files that are damaged, cut, foreign or out of reach.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <random>

#include "depth_fusion/store/database.h"
#include "support/expect_error.h"
#include "support/file_bytes.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

// A file of a few levels of pages, with long values and short ones.
std::string makeFile(const std::string& path) {
  const auto writer = openDatabase(path, DatabaseAccess::kWrite)->write();
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    std::string value(i % 10 == 0 ? 9000 : 60, '\0');
    for (char& byte : value) byte = static_cast<char>(random());
    writer->put("key " + std::to_string(i), value);
  }
  writer->commit();
  return fileBytes(path);
}

TEST(LmdbDatabase, FilesThatWereCutAreRefused) {
  const TemporaryFolder folder;
  const std::string whole = makeFile(folder / "whole.map");
  for (const double part : {0.001, 0.1, 0.5, 0.9, 0.999}) {
    const std::string path = folder / ("cut" + std::to_string(part) + ".map");
    writeFileBytes(path, whole.substr(0, static_cast<size_t>(part * whole.size())));
    expectError([&] { openDatabase(path, DatabaseAccess::kRead); }, {path});
    expectError([&] { openDatabase(path, DatabaseAccess::kWrite); }, {path});
  }
}

// The file's structure is what LMDB trusts; what is in the values, the rows' own checksums tell.
TEST(LmdbDatabase, FlippedBitsEndNoProcess) {
  const TemporaryFolder folder;
  const std::string whole = makeFile(folder / "whole.map");
  std::mt19937 random(2);
  int refused = 0;
  for (int i = 0; i < 200; ++i) {
    std::string bytes = whole;
    // Half of them in the first pages, which lead to all others.
    const size_t range = i % 2 == 0 ? bytes.size() : 16384;
    for (int flip = 0; flip < 3; ++flip) bytes[random() % range] ^= static_cast<char>(1 << random() % 8);
    const std::string path = folder / "flipped.map";
    unlink(path.c_str());
    writeFileBytes(path, bytes);
    try {
      openDatabase(path, DatabaseAccess::kRead)->read()->forEach("", [](const auto&, const auto&) {});
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0) << "the flips do not reach what matters";
}

TEST(LmdbDatabase, OtherFilesAreLeftAlone) {
  const TemporaryFolder folder;
  const std::string path = folder / "notes.txt";
  for (const size_t bytes : {5, 5000, 50000}) {
    const std::string text(bytes, 'x');
    writeFileBytes(path, text);
    expectError([&] { openDatabase(path, DatabaseAccess::kWrite); }, {path});
    EXPECT_EQ(fileBytes(path), text);
  }
  expectError([&] { openDatabase(folder.path(), DatabaseAccess::kWrite); }, {"is a folder"});
  expectError([&] { openDatabase(folder / "no/such/x.map", DatabaseAccess::kWrite); },
              {"no/such", "cannot be written"});
  expectError([&] { openDatabase("", DatabaseAccess::kRead); }, {"no place"});
}

TEST(LmdbDatabase, ReadingChangesNoByte) {
  const TemporaryFolder folder;
  const std::string before = makeFile(folder / "rows.map");
  {
    const auto database = openDatabase(folder / "rows.map", DatabaseAccess::kRead);
    EXPECT_TRUE(database->read()->get("key 7"));
  }
  EXPECT_EQ(fileBytes(folder / "rows.map"), before);
}

}  // namespace
}  // namespace depth_fusion
