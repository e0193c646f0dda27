// Text files of one record a line: '#' starts a comment, blank lines are skipped.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace depth_fusion {

struct TextLine {
  std::string text;
  std::string where;  // "path:line", for messages
};

// Throws Error if the file cannot be read.
std::vector<TextLine> readTextLines(const std::string& path);

// The numbers of a text, separated by blanks or commas, or nothing if it holds anything else.
std::optional<std::vector<double>> parseNumbers(std::string text);

// Replaces the file. Throws Error if it cannot be written completely.
void writeText(const std::string& path, const std::string& text);

// The shortest decimal number with at least six decimals that reads back as the same double.
std::string stampText(double stamp_s);

}  // namespace depth_fusion
