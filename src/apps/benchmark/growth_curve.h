// benchmark growth: the time of the stages over what they may grow with, as a table, a plot and exponents.
#pragma once

#include <string>
#include <vector>

#include "apps/benchmark/growth_walk.h"

namespace depth_fusion {

// Holds a walk's medians since its timing started, and what it had come to by then.
struct GrowthSample {
  size_t frames = 0, lost = 0, blocks = 0;
  double blocks_in_view = 0.0;  // mean
  CameraIntrinsics camera;
  double voxel_mm = 0.0;
  double rss_mib = 0.0;         // of the process
  double new_surface_ms = 0.0;  // median frame on the way forth, where blocks are allocated; 0: not measured
  std::vector<double> stages_ms;  // in the order of growthStages()
};

struct GrowthStage {
  std::string timer, name;
};
const std::vector<GrowthStage>& growthStages();  // the last is the whole frame

struct GrowthCurve {
  std::string name;  // of its files
  std::string title, x_label;
  double (*x)(const GrowthSample&);
  bool logarithmic = false;
  std::vector<GrowthSample> samples = {};
};

// The memory that this process holds now, in MiB.
double residentSet_mib();

std::string growthTableHead();
std::string growthTableRow(const GrowthSample& sample);

// Writes FOLDER/NAME.csv and .png, and prints each stage's exponent and whether it is at most linear.
void report(const GrowthCurve& curve, const std::string& folder);

}  // namespace depth_fusion
