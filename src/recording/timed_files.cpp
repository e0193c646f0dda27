#include "recording/timed_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "common/io/image_file.h"
#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr char kSeparators[] = " \t,;";

bool earlierFile(const TimedFile& a, const TimedFile& b) { return a.stamp_s < b.stamp_s; }

std::optional<double> parseStamp(const std::string& text) {
  const auto numbers = parseNumbers(text);
  if (!numbers || numbers->size() != 1 || !std::isfinite(numbers->front())) return std::nullopt;
  return stampSeconds(numbers->front());
}

bool isThere(const std::filesystem::path& path) {
  std::error_code none;  // a name that no file can have is no file's
  return std::filesystem::exists(path, none);
}

// Names may stand in quotes, hold blanks, and have the separators of Windows. One that leads nowhere may be
// that of a folder that was moved, or go from the folder above: what it ends with is looked for.
std::string pathOf(const std::string& name, const std::filesystem::path& folder) {
  std::string wanted = trimmed(name, " \t,;\"'");
  if (isThere(folder / wanted)) return (folder / wanted).string();
  std::replace(wanted.begin(), wanted.end(), '\\', '/');
  for (size_t begin = 0; begin != std::string::npos; begin = wanted.find('/', begin)) {
    begin = std::min(wanted.find_first_not_of('/', begin), wanted.size());
    if (begin < wanted.size() && isThere(folder / wanted.substr(begin)))
      return (folder / wanted.substr(begin)).string();
  }
  return (folder / wanted).string();
}

// "stamp file", the file being what follows the stamp up to the text's end.
std::optional<TimedFile> parseTimedFile(const std::string& text, const std::filesystem::path& folder) {
  const size_t stamp_end = text.find_first_of(kSeparators);
  if (stamp_end == std::string::npos) return std::nullopt;
  const auto stamp_s = parseStamp(text.substr(0, stamp_end));
  const std::string name = trimmed(text.substr(stamp_end), kSeparators);
  if (!stamp_s || name.empty()) return std::nullopt;
  return TimedFile{*stamp_s, pathOf(name, folder)};
}

// "stamp file stamp file": the second entry begins at the first number after a name.
std::optional<TimedPair> parseTimedPair(const std::string& text, const std::filesystem::path& folder) {
  size_t begin = text.find_first_of(kSeparators);
  for (int word = 1; begin != std::string::npos; ++word) {
    begin = text.find_first_not_of(kSeparators, begin);
    if (begin == std::string::npos) break;
    const size_t end = text.find_first_of(kSeparators, begin);
    if (word > 1 && end != std::string::npos && parseStamp(text.substr(begin, end - begin))) {
      const auto first = parseTimedFile(text.substr(0, begin), folder);
      const auto second = parseTimedFile(text.substr(begin), folder);
      if (first && second) return TimedPair{*first, *second};
    }
    begin = end;
  }
  return std::nullopt;
}

// The entries of the list's lines that parse() understands.
template <class Entry, class Parse>
std::vector<Entry> readEntries(const std::string& list_path, const std::string& expected, std::string* remark,
                               const Parse& parse) {
  const std::filesystem::path folder = std::filesystem::path(list_path).parent_path();
  std::vector<Entry> entries;
  LeftOut left_out;
  for (const TextLine& line : readTextLines(list_path)) {
    if (const std::optional<Entry> entry = parse(withDecimalPoints(line.text), folder)) {
      entries.push_back(*entry);
    } else {
      left_out.add(line.where + ": '" + line.text + "' is not an entry; expected '" + expected + "'");
    }
  }
  check(!entries.empty() || !left_out.empty(),
        list_path + ": lists no file; expected lines '" + expected + "'");
  check(!entries.empty(), left_out.firstProblem());
  if (remark != nullptr && !left_out.empty()) *remark += "; " + left_out.text("line");
  return entries;
}

// Several images of one stamp get one and the same colour, and no motion between them.
void noteEqualStamps(const std::vector<TimedFile>& files, const std::string& list_path, std::string& remark) {
  size_t equal = 0;
  for (size_t i = 1; i < files.size(); ++i) {
    if (files[i].stamp_s == files[i - 1].stamp_s) ++equal;
  }
  if (equal > 0)
    remark += "; " + std::to_string(equal) + " of the " + std::to_string(files.size()) + " images of " +
              list_path + " have the stamp of another";
}

// Pairs of which the first is depth, or of which the second is.
bool depthIsSecond(const std::vector<TimedPair>& pairs) {
  const auto isDepth = [](const TimedFile& file) {
    const auto header = readPngHeader(file.path);
    return header && header->is_depth;
  };
  for (const TimedPair& pair : pairs) {
    if (isDepth(pair.depth) != isDepth(pair.color)) return isDepth(pair.color);
  }
  const auto isNamedDepth = [](const TimedFile& file) {
    return file.path.find("depth") != std::string::npos;
  };
  return isNamedDepth(pairs.front().color) && !isNamedDepth(pairs.front().depth);
}

}  // namespace

std::vector<TimedFile> readTimedFiles(const std::string& list_path, std::string* remark) {
  auto files = readEntries<TimedFile>(list_path, "stamp file", remark, parseTimedFile);
  std::stable_sort(files.begin(), files.end(), earlierFile);
  if (remark != nullptr) noteEqualStamps(files, list_path, *remark);
  return files;
}

std::vector<TimedPair> readTimedPairs(const std::string& list_path, std::string* remark) {
  auto pairs = readEntries<TimedPair>(list_path, "stamp file stamp file", remark, parseTimedPair);
  if (depthIsSecond(pairs)) {
    for (TimedPair& pair : pairs) std::swap(pair.depth, pair.color);
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const TimedPair& a, const TimedPair& b) { return earlierFile(a.depth, b.depth); });
  return pairs;
}

const TimedFile* nearestFile(const std::vector<TimedFile>& files, double stamp_s, double max_gap_s) {
  const auto gap_s = [&](const TimedFile& file) { return std::abs(file.stamp_s - stamp_s); };
  const auto after = std::lower_bound(files.begin(), files.end(), TimedFile{stamp_s, ""}, earlierFile);
  const TimedFile* nearest = nullptr;
  if (after != files.end()) nearest = &*after;
  if (after != files.begin() && (nearest == nullptr || gap_s(*std::prev(after)) <= gap_s(*nearest))) {
    nearest = &*std::prev(after);
  }
  return nearest != nullptr && gap_s(*nearest) <= max_gap_s ? nearest : nullptr;
}

}  // namespace depth_fusion
