#include "apps/benchmark/filters.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <opencv2/imgcodecs.hpp>

#include "depth_fusion/common/error.h"
#include "depth_fusion/tsdf_fusion/tsdf_fusion_parameters.h"
#include "tools/evaluation/wall_experiment.h"
#include "tools/plots/line_plot.h"

namespace depth_fusion {
namespace {

constexpr double kSigma_m = 0.0019;  // of a Kinect at 1 m
constexpr int kFrames = 200;
constexpr int kTail = 50;

// The simplest comes first.
std::vector<std::string> rulesByComplexity() {
  std::vector<std::string> rules = fusionRules();
  std::reverse(rules.begin(), rules.end());
  return rules;
}

struct FiltersArguments {
  std::string output = "docs";
  std::string device;
};

// Writes NAME.csv, the lines' points, and NAME.png.
void write(const std::string& folder, const std::string& name, const LinePlot& plot) {
  const std::string path = folder + "/" + name;
  std::ofstream table(path + ".csv");
  table << "line," << plot.x_label << "," << plot.y_label << "\n";
  for (const PlotLine& line : plot.lines) {
    for (const cv::Point2d& point : line.points)
      table << line.name << "," << point.x << "," << point.y << "\n";
  }
  check(table.flush().good() && cv::imwrite(path + ".png", draw(plot)),
        path + ": cannot be written; does the folder exist, and is it writable?");
  std::printf("written: %s.csv, %s.png\n", path.c_str(), path.c_str());
}

PlotLine lineOf(const std::string& name, const std::vector<WallError>& errors) {
  PlotLine line{name, {}};
  for (size_t i = 0; i < errors.size(); ++i) {
    line.points.emplace_back(static_cast<double>(i), 1000.0 * errors[i].rms_m);
  }
  return line;
}

PlotLine underGrowingNoise(ComputeContext& compute, const std::string& name, const std::string& rule,
                           bool told) {
  WallExperiment experiment = growingNoise();
  experiment.told_of_noise = told;
  const auto errors =
      runWallExperiment(compute, experiment, filterOfGain(rule, 0.05, experiment.first_sigma_m));
  std::printf("growing noise, %-14s last %d frames %.3f mm, last %d %.3f mm\n", name.c_str(),
              experiment.frames / 10, 1000.0 * rootMeanSquare(errors, errors.size() - experiment.frames / 10),
              kTail, 1000.0 * rootMeanSquare(errors, errors.size() - kTail));
  return lineOf(name, errors);
}

// Compares filters that have the same gain at first. The Kalman filter is told of the noise.
void compareUnderGrowingNoise(ComputeContext& compute, const std::string& folder) {
  LinePlot plot{
      "noise grows from 1.9 to 6.1 mm; all filters begin with a gain of 0.05", "frame", "RMS error [mm]", {}};
  for (const std::string& rule : rulesByComplexity()) {
    plot.lines.push_back(underGrowingNoise(compute, rule, rule, rule == "kalman"));
  }
  plot.lines.push_back(underGrowingNoise(compute, "weighted, told", "weighted", true));
  write(folder, "filters_growing_noise", plot);
}

// Runs a wall that moves by 4 mm in mid-run: the error of the whole history tells how fast a filter answers,
// that of the last frames how well it smooths.
void qualityAgainstResponse(ComputeContext& compute, const std::string& folder) {
  WallExperiment experiment;
  experiment.frames = kFrames;
  experiment.first_sigma_m = kSigma_m;
  experiment.frame_at = [](int frame) { return WallFrame{frame < kFrames / 4 ? 1.0 : 1.004, kSigma_m}; };
  LinePlot plot{"a wall moves by 4 mm; gains from 0.02 to 0.4",
                "error of the last 50 frames [mm]",
                "error of all frames [mm]",
                {}};
  LinePlot history{"a wall moves by 4 mm; gain 0.05", "frame", "RMS error [mm]", {}};
  for (const std::string& rule : rulesByComplexity()) {
    PlotLine line{rule, {}};
    for (const double gain : {0.02, 0.03, 0.05, 0.08, 0.13, 0.2, 0.3, 0.4}) {
      const auto errors = runWallExperiment(compute, experiment, filterOfGain(rule, gain, kSigma_m));
      const double tail_mm = 1000.0 * rootMeanSquare(errors, errors.size() - kTail);
      const double all_mm = 1000.0 * rootMeanSquare(errors, 0);
      std::printf("quality and response, %-8s gain %.2f: last %d frames %.3f mm, all %.3f mm\n", rule.c_str(),
                  gain, kTail, tail_mm, all_mm);
      line.points.emplace_back(tail_mm, all_mm);
      if (gain == 0.05) history.lines.push_back(lineOf(rule, errors));
    }
    plot.lines.push_back(line);
  }
  write(folder, "filters_quality_response", plot);
  write(folder, "filters_history", history);
}

}  // namespace

void addFiltersBenchmark(CLI::App& app) {
  CLI::App* filters = app.add_subcommand("filters", "the paper's comparison of the filters of fusion");
  const auto arguments = std::make_shared<FiltersArguments>();
  filters->add_option("-o,--output", arguments->output, "folder for tables (.csv) and plots (.png)")
      ->capture_default_str();
  filters->add_option("--device", arguments->device, "OpenCL device: index, part of its name, cpu or gpu");
  filters->callback([arguments] {
    std::filesystem::create_directories(arguments->output);
    ComputeContext compute(arguments->device);
    compareUnderGrowingNoise(compute, arguments->output);
    qualityAgainstResponse(compute, arguments->output);
  });
}

}  // namespace depth_fusion
