// Errors and what they must say.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "depth_fusion/common/error.h"

namespace depth_fusion {

// Expects an Error of one line that holds each of the words.
template <class Action>
void expectError(const Action& action, const std::vector<std::string>& words) {
  try {
    action();
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& word : words) {
      EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' is not in: " << message;
    }
    return;
  }
  ADD_FAILURE() << "no Error was thrown";
}

}  // namespace depth_fusion
