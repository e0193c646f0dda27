// Text files of one record a line, by any editor: UTF-8 or UTF-16, with the mark of it or without, lines that
// end as anywhere. A '#' at a line's begin or after a blank starts a comment, blank lines are skipped.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace depth_fusion {

struct TextLine {
  std::string text;   // without blanks at both ends
  std::string where;  // "path:line", for messages
};

// Throws Error if the file cannot be read.
std::vector<TextLine> readTextLines(const std::string& path);

// The text without these marks at its begin and end.
std::string trimmed(const std::string& text, const char* marks);

// Lines, or files, that are no use. What is left out is said.
class LeftOut {
 public:
  void add(const std::string& problem) {
    if (count_++ == 0) first_problem_ = problem;
  }
  bool empty() const { return count_ == 0; }
  const std::string& firstProblem() const { return first_problem_; }
  // "2 lines left out, the first: PROBLEM".
  std::string text(const std::string& what) const;

 private:
  size_t count_ = 0;
  std::string first_problem_;
};

// The text with points where its numbers have commas, as half of the world writes them: "1,5 a.png" is
// "1.5 a.png". Where blanks separate nothing, commas may do, and the text stays as it is.
std::string withDecimalPoints(const std::string& text);

// The numbers of a text, separated by blanks, commas or semicolons, or nothing if it holds anything else.
// "inf", "nan", "1.#INF", "-1.#IND" and the like are numbers, which are not finite.
std::optional<std::vector<double>> parseNumbers(const std::string& text);

// A stamp as seconds: one that would be later than the year 5000 is in milli-, micro- or nanoseconds.
double stampSeconds(double stamp);

// Replaces the file. Throws Error if it cannot be written completely.
void writeText(const std::string& path, const std::string& text);

// The shortest decimal number with at least six decimals that reads back as the same double.
std::string stampText(double stamp_s);

}  // namespace depth_fusion
