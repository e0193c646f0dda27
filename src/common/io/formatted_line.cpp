#include "common/io/formatted_line.h"

#include <cstdarg>
#include <cstdio>

namespace depth_fusion {

std::string line(const char* format, ...) {
  char text[500];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof(text), format, arguments);
  va_end(arguments);
  return std::string(text) + "\n";
}

}  // namespace depth_fusion
