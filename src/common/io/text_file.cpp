#include "common/io/text_file.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "depth_fusion/common/error.h"

namespace depth_fusion {

namespace {

constexpr char kBlanks[] = " \t\v\f";

std::string readBytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  check(file.good(), path + ": cannot be read: " + std::strerror(errno));
  std::ostringstream bytes;
  bytes << file.rdbuf();
  check(!file.bad() && !std::filesystem::is_directory(path),
        path + ": reading failed: " + std::strerror(errno));
  return bytes.str();
}

// UTF-16, as some editors of Windows write it, as UTF-8; pairs of surrogates become question marks.
std::string fromUtf16(const std::string& bytes, bool big_endian) {
  std::string text;
  for (size_t i = 2; i + 1 < bytes.size(); i += 2) {
    const auto high = static_cast<unsigned char>(bytes[i + (big_endian ? 0 : 1)]);
    const auto low = static_cast<unsigned char>(bytes[i + (big_endian ? 1 : 0)]);
    const unsigned unit = 256u * high + low;
    if (unit < 0x80) {
      text += static_cast<char>(unit);
    } else if (unit < 0x800) {
      text += {static_cast<char>(0xc0 | unit >> 6), static_cast<char>(0x80 | (unit & 0x3f))};
    } else if (unit >= 0xd800 && unit < 0xe000) {
      text += '?';
    } else {
      text += {static_cast<char>(0xe0 | unit >> 12), static_cast<char>(0x80 | (unit >> 6 & 0x3f)),
               static_cast<char>(0x80 | (unit & 0x3f))};
    }
  }
  return text;
}

// The text without the mark of its encoding, with lines that end as here.
std::string readPlainText(const std::string& path) {
  std::string text = readBytes(path);
  if (text.rfind("\xff\xfe", 0) == 0 || text.rfind("\xfe\xff", 0) == 0)
    text = fromUtf16(text, text[0] == '\xfe');
  if (text.rfind("\xef\xbb\xbf", 0) == 0) text.erase(0, 3);
  std::replace(text.begin(), text.end(), '\r', '\n');
  return text;
}

// A comment begins the line or follows a blank: "1.#INF" holds none.
void removeComment(std::string& line) {
  for (size_t mark = line.find('#'); mark != std::string::npos; mark = line.find('#', mark + 1)) {
    if (mark != 0 && std::strchr(kBlanks, line[mark - 1]) == nullptr) continue;
    line.erase(mark);
    return;
  }
}

// Reads a number at the text's begin, also as the C library of Windows writes one that is none: 1.#INF,
// -1.#IND.
double readNumber(const char* text, char** end) {
  double number = std::strtod(text, end);
  if (*end == text || **end != '#') return number;
  const bool is_infinite = std::strncmp(*end, "#INF", 4) == 0;
  number = is_infinite ? std::copysign(std::numeric_limits<double>::infinity(), number)
                       : std::numeric_limits<double>::quiet_NaN();
  while (**end == '#' || std::isalnum(static_cast<unsigned char>(**end)) != 0) ++*end;
  return number;
}

size_t digitsEnd(const std::string& word, size_t begin) {
  return std::min(word.find_first_not_of("0123456789", begin), word.size());
}

// Where the word, which is a number like -12,5 or 1,2e-05, has its comma.
std::optional<size_t> decimalComma(const std::string& word) {
  const size_t begin = word.find_first_of("+-") == 0 ? 1 : 0;
  const size_t comma = digitsEnd(word, begin);
  if (comma == begin || comma >= word.size() || word[comma] != ',') return std::nullopt;
  size_t end = digitsEnd(word, comma + 1);
  if (end == comma + 1) return std::nullopt;
  if (end < word.size() && std::tolower(static_cast<unsigned char>(word[end])) == 'e')
    end = digitsEnd(word, std::min(word.find_first_not_of("+-", end + 1), word.size()));
  return end == word.size() ? std::optional<size_t>(comma) : std::nullopt;
}

}  // namespace

std::string LeftOut::text(const std::string& what) const {
  return std::to_string(count_) + " " + what + (count_ == 1 ? " left out: " : "s left out, the first: ") +
         first_problem_;
}

std::string withDecimalPoints(const std::string& text) {
  std::string changed = text;
  size_t words = 0;
  for (size_t begin = 0; (begin = text.find_first_not_of(kBlanks, begin)) != std::string::npos; ++words) {
    const size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    if (const auto comma = decimalComma(text.substr(begin, end - begin))) changed[begin + *comma] = '.';
    begin = end;
  }
  return words > 1 ? changed : text;
}

std::vector<TextLine> readTextLines(const std::string& path) {
  std::istringstream file(readPlainText(path));
  std::vector<TextLine> lines;
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    removeComment(text);
    text = trimmed(text, kBlanks);
    if (!text.empty()) lines.push_back({text, path + ":" + std::to_string(number)});
  }
  return lines;
}

std::string trimmed(const std::string& text, const char* marks) {
  const size_t begin = text.find_first_not_of(marks);
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(marks) + 1 - begin);
}

std::optional<std::vector<double>> parseNumbers(const std::string& text) {
  constexpr char kSeparators[] = " \t\v\f\r\n,;";
  std::vector<double> numbers;
  const char* rest = text.c_str();
  while (*(rest += std::strspn(rest, kSeparators)) != '\0') {
    char* end = nullptr;
    numbers.push_back(readNumber(rest, &end));
    if (end == rest || (*end != '\0' && std::strchr(kSeparators, *end) == nullptr)) return std::nullopt;
    rest = end;
  }
  return numbers;
}

double stampSeconds(double stamp) {
  constexpr double kLatest_s = 1e11;  // the year 5138
  for (const double unit_s : {1.0, 1e-3, 1e-6}) {
    if (std::abs(stamp) * unit_s < kLatest_s) return stamp * unit_s;
  }
  return stamp * 1e-9;
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
