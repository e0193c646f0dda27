// Words whatever the case of their letters.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace depth_fusion {

// The text with small letters in place of ASCII's capitals.
inline std::string lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

}  // namespace depth_fusion
