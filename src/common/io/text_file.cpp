#include "common/io/text_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "depth_fusion/common/error.h"

namespace depth_fusion {

std::vector<TextLine> readTextLines(const std::string& path) {
  std::ifstream file(path);
  check(file.good(), path + ": cannot be read: " + std::strerror(errno));
  std::vector<TextLine> lines;
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    text.erase(std::min(text.find('#'), text.size()));
    text.erase(text.find_last_not_of(" \t\r") + 1);
    if (!text.empty()) lines.push_back({text, path + ":" + std::to_string(number)});
  }
  check(file.eof(), path + ": reading failed: " + std::strerror(errno));
  return lines;
}

std::optional<std::vector<double>> parseNumbers(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::vector<double> numbers;
  const char* rest = text.c_str();
  while (*(rest += std::strspn(rest, " \t\r\n")) != '\0') {
    char* end = nullptr;
    numbers.push_back(std::strtod(rest, &end));
    const bool ends_at_blank = *end == '\0' || std::strchr(" \t\r\n", *end) != nullptr;
    if (end == rest || !ends_at_blank) return std::nullopt;
    rest = end;
  }
  return numbers;
}

void writeText(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  check(file.good(), path + ": cannot be written: " + std::strerror(errno));
}

std::string stampText(double stamp_s) {
  constexpr int kMostDecimals = 24;
  char text[352];
  for (int decimals = 6; decimals <= kMostDecimals; ++decimals) {
    std::snprintf(text, sizeof(text), "%.*f", decimals, stamp_s);
    if (std::strtod(text, nullptr) == stamp_s) break;
  }
  return text;
}

}  // namespace depth_fusion
