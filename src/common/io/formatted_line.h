// Lines of reports.
#pragma once

#include <string>

namespace depth_fusion {

// The text as printf makes it, of 499 characters at most, with a newline at its end.
__attribute__((format(printf, 1, 2))) std::string line(const char* format, ...);

}  // namespace depth_fusion
