#include "apps/calibrate/report.h"

#include <nlohmann/json.hpp>

#include "common/io/formatted_line.h"
#include "common/io/image_file.h"
#include "common/io/text_file.h"
#include "tools/plots/calibration_picture.h"

namespace depth_fusion {
namespace {

using Json = nlohmann::ordered_json;

std::string timeText(const CalibrationReport& report) {
  const TimeOffset& color = report.color;
  std::string text = color.found ? line("colour: taken at its stamp %+.1f +- %.1f ms, by the depth's clock",
                                        1e3 * color.offset_s.value, 1e3 * color.offset_s.sigma)
                                 : line("colour: time offset not known: %s", color.reason.c_str());
  if (!report.poses) return text + line("depth's stamps against poses: not known without --trajectory");
  const TimeOffset& poses = *report.poses;
  return text + (poses.found
                     ? line("depth: taken at its stamp %+.1f +- %.1f ms, by the trajectory's clock",
                            1e3 * poses.offset_s.value, 1e3 * poses.offset_s.sigma)
                     : line("depth: time offset to the trajectory not known: %s", poses.reason.c_str()));
}

std::string scaleText(const CalibrationReport& report) {
  if (!report.scale) {
    return line(
        "depth scale: not known: no depth camera can tell it without a length from outside; give "
        "--trajectory or "
        "--distance");
  }
  return line("depth scale: %.4f +- %.4f", report.scale->value, report.scale->sigma);
}

Json toJson(const Estimate& estimate) { return {{"value", estimate.value}, {"sigma", estimate.sigma}}; }

Json toJson(const TimeOffset& offset) {
  if (offset.found) return toJson(offset.offset_s);
  return {{"unknown", offset.reason}};
}

Json toJson(const cv::Mat& grid) { return std::vector<float>(grid.begin<float>(), grid.end<float>()); }

Json toJson(const PartVerdict& verdict) {
  return {{"applied", verdict.applied}, {"gain_sigmas", verdict.gain_sigmas}};
}

Json partsJson(const DepthCalibration& depth) {
  Json json;
  const char* names[kPartCount] = {"mean", "tilt", "shape", "readout"};
  for (size_t part = 0; part < kPartCount; ++part) json[names[part]] = toJson(depth.parts[part]);
  return json;
}

Json toJson(const CalibrationReport& report) {
  const SelfCalibration& calibration = report.calibration;
  const DepthCalibration& depth = calibration.depth;
  Json json = {
      {"input", report.input},
      {"frames",
       {{"read", calibration.tracked.read},
        {"tracked", calibration.tracked.trajectory.size()},
        {"used", calibration.frames_used}}},
      {"pairs", depth.pairs},
      {"planes", depth.planes},
      {"offsets_per_m", toJson(depth.offsets_per_m)},
      {"offset_sigmas_per_m", toJson(depth.sigmas_per_m)},
      {"observed_offsets", depth.observed_offsets},
      {"flatness_per_m", {{"before", depth.before.rms_per_m}, {"after", depth.after.rms_per_m}}},
      {"readout_s", toJson(depth.readout_s)},
      {"parts", partsJson(depth)},
      {"explained", {{"before", calibration.explained_before}, {"after", calibration.tracked.explained}}},
      {"refused", calibration.refused},
      {"color_offset_s", toJson(report.color)}};
  if (report.poses) json["pose_offset_s"] = toJson(*report.poses);
  if (report.scale) json["depth_scale"] = toJson(*report.scale);
  return json;
}

}  // namespace

std::string reportText(const CalibrationReport& report) {
  const SelfCalibration& calibration = report.calibration;
  return line("%zu frames read, %zu tracked, %zu used: %d pairs that see the same, %d planes",
              calibration.tracked.read, calibration.tracked.trajectory.size(), calibration.frames_used,
              calibration.depth.pairs, calibration.depth.planes) +
         calibrationText(calibration) + timeText(report) + scaleText(report);
}

void writeCalibration(const std::string& folder, const CalibrationReport& report) {
  std::string yaml =
      "# The depth of the sensor of " + report.input + ", by calibrate; for its images as they are there.\n";
  PipelineParameters corrected = report.calibration.corrected;
  const ParameterTable table = corrected.table();
  const auto line = [&](const std::string& stage, const std::string& name) {
    return "  " + name + ": " + valueText(findParameter(table, stage + "/" + name)) + "\n";
  };
  yaml += "registration:\n" + line("registration", "depth_scale") + "preprocessing:\n";
  if (!corrected.preprocessing.depth_offsets_per_m.empty())
    yaml += line("preprocessing", "depth_offsets_per_m");
  for (const std::string name : {"readout_s", "stamp_delay_s"}) yaml += line("preprocessing", name);
  writeText(folder + "/calibration.yaml", yaml);
  writeText(folder + "/report.json", toJson(report).dump(2) + "\n");
  writePicture(folder + "/calibration.png", drawCalibration(report.calibration.depth));
}

}  // namespace depth_fusion
