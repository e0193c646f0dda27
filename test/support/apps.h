// Runs the built apps as a user would, as processes of their own.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/file_bytes.h"
#include "support/temporary_folder.h"

namespace depth_fusion {

struct AppRun {
  int status = -1;     // exit status; -1 if the app did not exit by itself
  std::string output;  // standard output
  std::string errors;  // standard error
};

inline std::string shellQuoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// The environment holds "NAME=value" each.
inline AppRun runApp(const std::string& app, const std::vector<std::string>& arguments,
                     const std::vector<std::string>& environment = {}) {
  const TemporaryFolder folder;
  std::string command = "env";
  for (const std::string& variable : environment) command += " " + shellQuoted(variable);
  command += " " + shellQuoted(DEPTH_FUSION_APPS "/" + app);
  for (const std::string& argument : arguments) command += " " + shellQuoted(argument);
  command += " >" + shellQuoted(folder / "output") + " 2>" + shellQuoted(folder / "errors");
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, fileBytes(folder / "output"),
          fileBytes(folder / "errors")};
}

inline nlohmann::json readReport(const std::string& output_folder) {
  return nlohmann::json::parse(fileBytes(output_folder + "/report.json"));
}

}  // namespace depth_fusion
