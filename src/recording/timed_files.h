// Lists of the TUM layout: "stamp file" a line.
#pragma once

#include <string>
#include <vector>

namespace depth_fusion {

struct TimedFile {
  double stamp_s = 0.0;
  std::string path;
};

// The files of a list, sorted by stamp, with paths that begin with the list's folder. The remark says which
// lines are no entries and left out, and how many stamps are equal. Throws Error naming the first line that
// is no entry if there is no other, or a list that is missing or empty.
std::vector<TimedFile> readTimedFiles(const std::string& list_path, std::string* remark = nullptr);

// Depth with the colour that belongs to it.
struct TimedPair {
  TimedFile depth, color;
};

// The pairs of a list as associate.py writes it, "stamp file stamp file" a line, sorted by the stamp of the
// depth. The images themselves tell which of the two columns is depth, and where they cannot be read, their
// names. Else as readTimedFiles.
std::vector<TimedPair> readTimedPairs(const std::string& list_path, std::string* remark = nullptr);

// The file of a sorted list nearest in time, or nullptr if none lies within max_gap_s.
const TimedFile* nearestFile(const std::vector<TimedFile>& files, double stamp_s, double max_gap_s);

}  // namespace depth_fusion
