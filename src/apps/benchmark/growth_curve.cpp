#include "apps/benchmark/growth_curve.h"

#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "common/io/image_file.h"
#include "common/io/text_file.h"
#include "tools/evaluation/power_law.h"
#include "tools/plots/line_plot.h"

namespace depth_fusion {
namespace {

constexpr double kLinear = 1.05;  // an exponent that noise may give a line

PlotLine growthLine(const GrowthCurve& curve, size_t stage) {
  PlotLine line{growthStages()[stage].name, {}};
  for (const GrowthSample& sample : curve.samples)
    line.points.emplace_back(curve.x(sample), sample.stages_ms[stage]);
  return line;
}

void printExponents(const GrowthCurve& curve, const std::vector<PlotLine>& lines) {
  std::printf("%s: time grows with [%s] to the power of\n", curve.name.c_str(), curve.x_label.c_str());
  for (const PlotLine& line : lines) {
    const double exponent = powerLawExponent(line.points);
    std::printf("  %5.2f  %s%s\n", exponent, line.name.c_str(),
                exponent > kLinear ? ": WORSE THAN LINEAR" : "");
  }
  std::fflush(stdout);
}

}  // namespace

const std::vector<GrowthStage>& growthStages() {
  static const std::vector<GrowthStage> stages = {{"preprocessing", "preprocessing"},
                                                  {"icp_tracking", "ICP tracking"},
                                                  {"tsdf_fusion/select_blocks", "block selection"},
                                                  {"tsdf_fusion/integrate", "integration"},
                                                  {"model_view", "model view"},
                                                  {"frame", "frame"}};
  return stages;
}

double residentSet_mib() {
  std::ifstream file("/proc/self/statm");
  double total_pages = 0.0, resident_pages = 0.0;
  file >> total_pages >> resident_pages;
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

std::string growthTableHead() {
  std::string head =
      "frames,lost,blocks,blocks in view,width,height,voxel [mm],RSS [MiB],frame of new surface [ms]";
  for (const GrowthStage& stage : growthStages()) head += "," + stage.name + " [ms]";
  return head + "\n";
}

std::string growthTableRow(const GrowthSample& sample) {
  char text[200];
  std::snprintf(text, sizeof(text), "%zu,%zu,%zu,%.0f,%d,%d,%.4g,%.0f,%.2f", sample.frames, sample.lost,
                sample.blocks, sample.blocks_in_view, sample.camera.width, sample.camera.height,
                sample.voxel_mm, sample.rss_mib, sample.new_surface_ms);
  std::string row = text;
  for (const double stage_ms : sample.stages_ms) {
    std::snprintf(text, sizeof(text), ",%.2f", stage_ms);
    row += text;
  }
  return row + "\n";
}

void report(const GrowthCurve& curve, const std::string& folder) {
  const std::string path = folder + "/" + curve.name;
  std::string table = growthTableHead();
  for (const GrowthSample& sample : curve.samples) table += growthTableRow(sample);
  writeText(path + ".csv", table);
  LinePlot plot{curve.title, curve.x_label, "median time a frame [ms]", {}, curve.logarithmic};
  for (size_t stage = 0; stage < growthStages().size(); ++stage)
    plot.lines.push_back(growthLine(curve, stage));
  writePicture(path + ".png", draw(plot));
  if (curve.samples.size() > 1) printExponents(curve, plot.lines);
}

}  // namespace depth_fusion
