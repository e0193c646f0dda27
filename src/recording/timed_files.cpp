#include "recording/timed_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

bool earlier(const TimedFile& a, const TimedFile& b) { return a.stamp_s < b.stamp_s; }

TimedFile parseTimedFile(const TextLine& line, const std::filesystem::path& folder) {
  const std::string blanks = " \t";
  const size_t stamp_begin = std::min(line.text.find_first_not_of(blanks), line.text.size());
  const size_t stamp_end = std::min(line.text.find_first_of(blanks, stamp_begin), line.text.size());
  const size_t name_begin = line.text.find_first_not_of(blanks, stamp_end);
  const auto stamp = parseNumbers(line.text.substr(stamp_begin, stamp_end - stamp_begin));
  check(name_begin != std::string::npos && stamp && stamp->size() == 1 && std::isfinite(stamp->front()),
        line.where + ": '" + line.text + "' is not an entry; expected 'stamp file'");
  return {stamp->front(), (folder / line.text.substr(name_begin)).string()};
}

}  // namespace

std::vector<TimedFile> readTimedFiles(const std::string& list_path) {
  const std::filesystem::path folder = std::filesystem::path(list_path).parent_path();
  std::vector<TimedFile> files;
  for (const TextLine& line : readTextLines(list_path)) files.push_back(parseTimedFile(line, folder));
  check(!files.empty(), list_path + ": lists no file; expected lines 'stamp file'");
  std::stable_sort(files.begin(), files.end(), earlier);
  return files;
}

const TimedFile* nearestFile(const std::vector<TimedFile>& files, double stamp_s, double max_gap_s) {
  const auto gap_s = [&](const TimedFile& file) { return std::abs(file.stamp_s - stamp_s); };
  const auto after = std::lower_bound(files.begin(), files.end(), TimedFile{stamp_s, ""}, earlier);
  const TimedFile* nearest = nullptr;
  if (after != files.end()) nearest = &*after;
  if (after != files.begin() && (nearest == nullptr || gap_s(*std::prev(after)) <= gap_s(*nearest))) {
    nearest = &*std::prev(after);
  }
  return nearest != nullptr && gap_s(*nearest) <= max_gap_s ? nearest : nullptr;
}

}  // namespace depth_fusion
