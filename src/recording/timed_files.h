// Lists of the TUM layout: "stamp file" a line.
#pragma once

#include <string>
#include <vector>

namespace depth_fusion {

struct TimedFile {
  double stamp_s = 0.0;
  std::string path;
};

// The files of a list, sorted by stamp, with paths that begin with the list's folder. Throws Error naming the
// line that cannot be read, or a list that is missing or empty.
std::vector<TimedFile> readTimedFiles(const std::string& list_path);

// The file of a sorted list nearest in time, or nullptr if none lies within max_gap_s.
const TimedFile* nearestFile(const std::vector<TimedFile>& files, double stamp_s, double max_gap_s);

}  // namespace depth_fusion
