#include "apps/benchmark/filters.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <opencv2/imgcodecs.hpp>

#include "depth_fusion/common/error.h"
#include "depth_fusion/evaluation/line_plot.h"
#include "depth_fusion/evaluation/wall_experiment.h"

namespace depth_fusion {
namespace {

constexpr double kFirstSigma_m = 0.0012;  // of a Kinect at 0.4 m
constexpr double kSigma_m = 0.0019;       // at 1 m
constexpr double kLastSigma_m = 0.0061;   // at 2 m
constexpr int kFrames = 200;
constexpr int kTail = 50;
const std::vector<std::string> kRules = {"average", "weighted", "kalman"};

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

// Filters of the same gain while the noise grows as if the sensor went from 0.4 m to 2 m. The Kalman filter is
// told.
void growingNoise(ComputeContext& compute, const std::string& folder) {
  WallExperiment experiment;
  experiment.frames = kFrames;
  experiment.first_sigma_m = kFirstSigma_m;
  experiment.frame_at = [](int frame) {
    return WallFrame{1.0, kFirstSigma_m + (kLastSigma_m - kFirstSigma_m) * frame / kFrames};
  };
  LinePlot plot{
      "noise grows from 1.2 to 6.1 mm; all filters begin with a gain of 0.05", "frame", "RMS error [mm]", {}};
  for (const std::string& rule : kRules) {
    experiment.told_of_noise = rule == "kalman";
    const auto errors = runWallExperiment(compute, experiment, filterOfGain(rule, 0.05, kFirstSigma_m));
    std::printf("growing noise, %-8s last 10 frames %.3f mm\n", rule.c_str(),
                1000.0 * rootMeanSquare(errors, errors.size() - 10));
    plot.lines.push_back(lineOf(rule, errors));
  }
  experiment.told_of_noise = true;
  const auto errors = runWallExperiment(compute, experiment, filterOfGain("weighted", 0.05, kFirstSigma_m));
  std::printf("growing noise, weighted, told of the noise: last 10 frames %.3f mm\n",
              1000.0 * rootMeanSquare(errors, errors.size() - 10));
  plot.lines.push_back(lineOf("weighted, told", errors));
  write(folder, "filters_growing_noise", plot);
}

// A wall that moves by 4 mm in mid-run: the error of the whole history tells how fast a filter answers, that
// of the last frames how well it smooths.
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
  for (const std::string& rule : kRules) {
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
    growingNoise(compute, arguments->output);
    qualityAgainstResponse(compute, arguments->output);
  });
}

}  // namespace depth_fusion
