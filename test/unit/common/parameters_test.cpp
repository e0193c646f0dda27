#include "depth_fusion/common/parameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

struct Stage {
  bool enabled = false;
  int levels = 3;
  float distance_m = 0.1f;
  std::string kind = "round";

  ParameterTable table() {
    return {flag("enabled", &enabled, "a flag"), number("levels", &levels, 1, 5, "a count"),
            number("distance_m", &distance_m, 0.01, 2.0, "a distance"),
            choice("kind", &kind, {"round", "square"}, "a choice")};
  }
};

// The message of the Error that the action throws; empty if it throws none.
template <class Action>
std::string errorOf(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string errorOfSetting(const std::string& name, const std::string& text) {
  Stage stage;
  return errorOf([&] { setParameter(stage.table(), name, text); });
}

class ParameterFile : public testing::Test {
 protected:
  void write(const std::string& text) { std::ofstream(path_) << text; }
  std::string errorOfLoading(const std::string& text) {
    write(text);
    return errorOf([&] { loadParameterFile(withPrefix("stage", stage_.table()), path_); });
  }
  ~ParameterFile() override { std::remove(path_.c_str()); }

  Stage stage_;
  std::string path_ = testing::TempDir() + "/depth_fusion_parameters_test.yaml";
};

TEST(Parameters, SetsEveryType) {
  Stage stage;
  setParameter(stage.table(), "enabled", "true");
  setParameter(stage.table(), "levels", "4");
  setParameter(stage.table(), "distance_m", "2.5e-1");
  EXPECT_TRUE(stage.enabled);
  EXPECT_EQ(stage.levels, 4);
  EXPECT_FLOAT_EQ(stage.distance_m, 0.25f);
  setParameter(stage.table(), "kind", "square");
  EXPECT_EQ(stage.kind, "square");
}

TEST(Parameters, ChoicesAreNamed) {
  EXPECT_EQ(errorOfSetting("kind", "oval"), "parameter 'kind' is 'oval'; it must be one of round, square");
  Stage stage;
  EXPECT_EQ(rangeText(stage.table()[2]), "[0.01, 2]");
  EXPECT_EQ(rangeText(stage.table()[3]), "round, square");
  stage.kind = "";
  EXPECT_NE(errorOf([&] { validate(stage.table()); }).find("'kind'"), std::string::npos);
}

TEST(Parameters, UnknownNameSuggestsTheNearest) {
  EXPECT_EQ(errorOfSetting("distanse_m", "1"), "unknown parameter 'distanse_m'; did you mean 'distance_m'?");
  EXPECT_EQ(errorOfSetting("level", "1"), "unknown parameter 'level'; did you mean 'levels'?");
}

TEST(Parameters, TextOfAnotherTypeIsRefused) {
  for (const char* text : {"", "four", "4.5", "4 5", "4x", "99999999999"}) {
    EXPECT_NE(errorOfSetting("levels", text).find("'levels'"), std::string::npos) << text;
  }
  for (const char* text : {"", "nan", "wide", "0,5"}) {
    EXPECT_NE(errorOfSetting("distance_m", text).find("'distance_m'"), std::string::npos) << text;
  }
  EXPECT_NE(errorOfSetting("enabled", "maybe").find("neither true nor false"), std::string::npos);
}

TEST(Parameters, LimitsAreInclusive) {
  EXPECT_EQ(errorOfSetting("levels", "1"), "");
  EXPECT_EQ(errorOfSetting("levels", "5"), "");
  EXPECT_EQ(errorOfSetting("distance_m", "0.01"), "");  // not exact in float
  EXPECT_EQ(errorOfSetting("levels", "6"), "parameter 'levels' is 6; it must lie in [1, 5]");
  EXPECT_NE(errorOfSetting("distance_m", "0.0099"), "");
}

TEST(Parameters, ValidateFindsWhatCodeHasSet) {
  Stage stage;
  validate(stage.table());
  stage.distance_m = NAN;
  EXPECT_NE(errorOf([&] { validate(stage.table()); }).find("'distance_m'"), std::string::npos);
  stage = Stage();
  stage.levels = 0;
  EXPECT_NE(errorOf([&] { validate(stage.table()); }).find("'levels'"), std::string::npos);
}

TEST(Parameters, ValueTextIsReadBack) {
  Stage stage;
  stage.enabled = true;
  Stage copy;
  for (const Parameter& parameter : stage.table())
    setParameter(copy.table(), parameter.name, valueText(parameter));
  EXPECT_EQ(copy.enabled, stage.enabled);
  EXPECT_EQ(copy.levels, stage.levels);
  EXPECT_EQ(copy.distance_m, stage.distance_m);
}

TEST(Parameters, ValueTextIsShortAndExact) {
  Stage stage;
  const ParameterTable table = stage.table();
  const Parameter& row = findParameter(table, "distance_m");
  for (const float value : {0.1f, 5e-5f, 1.0f / 3.0f, 0.1f + 1e-8f, 16777216.0f}) {
    stage.distance_m = value;
    EXPECT_EQ(std::strtof(valueText(row).c_str(), nullptr), value);
  }
  stage.distance_m = 0.1f;
  EXPECT_EQ(valueText(row), "0.1");
}

TEST(Parameters, RowsAreMarkedForTheStart) {
  Stage stage;
  for (const Parameter& row : stage.table()) EXPECT_FALSE(row.at_start_only);
  for (const Parameter& row : atStartOnly(stage.table())) EXPECT_TRUE(row.at_start_only);
}

TEST_F(ParameterFile, SetsTheParametersOfAStage) {
  EXPECT_EQ(errorOfLoading("stage:\n  levels: 2\n  enabled: true\n"), "");
  EXPECT_EQ(stage_.levels, 2);
  EXPECT_TRUE(stage_.enabled);
  EXPECT_FLOAT_EQ(stage_.distance_m, 0.1f);
}

TEST_F(ParameterFile, EmptyFileChangesNothing) {
  EXPECT_EQ(errorOfLoading(""), "");
  EXPECT_EQ(stage_.levels, 3);
}

TEST_F(ParameterFile, ErrorsNameTheFile) {
  for (const char* text : {"stage:\n  levls: 2\n", "stage:\n  levels: [1, 2]\n", "stage:\n  levels: two\n",
                           "stage: {levels: 9}\n", "just text\n", "a: [\n", "levels: 2\n"}) {
    EXPECT_NE(errorOfLoading(text).find(path_), std::string::npos) << text;
  }
  EXPECT_NE(errorOfLoading("stage:\n  levls: 2\n").find("did you mean 'stage/levels'"), std::string::npos);
  const std::string missing = path_ + ".missing";
  EXPECT_NE(errorOf([&] { loadParameterFile(stage_.table(), missing); }).find(missing), std::string::npos);
}

}  // namespace
}  // namespace depth_fusion
