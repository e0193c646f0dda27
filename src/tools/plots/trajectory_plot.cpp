#include "tools/plots/trajectory_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "depth_fusion/common/error.h"
#include "tools/plots/drawing.h"
#include "tools/plots/nice_step.h"

namespace depth_fusion {
namespace {

constexpr int kPanel_px = 640;
constexpr int kMargin_px = 80;
constexpr int kHeader_px = 70;
constexpr int kColorBar_px = 110;
constexpr int kSubpixelBits = 4;

const cv::Scalar kTruth(170, 170, 170);

struct Range {
  double low, high;
};

struct View {
  const char* title;
  int horizontal, vertical;  // axes of W
};

void writeText(cv::Mat& canvas, const std::string& text, const cv::Point& left_baseline, double size = 0.45) {
  cv::putText(canvas, text, left_baseline, cv::FONT_HERSHEY_SIMPLEX, size, kInk, 1, cv::LINE_AA);
}

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

Range rangeOf(const std::vector<PosePair>& pairs, int axis) {
  Range range{pairs.front().T_W_truth.translation()[axis], pairs.front().T_W_truth.translation()[axis]};
  for (const PosePair& pair : pairs) {
    for (const double value : {pair.T_W_truth.translation()[axis], pair.T_W_estimate.translation()[axis]}) {
      range = {std::min(range.low, value), std::max(range.high, value)};
    }
  }
  return range;
}

double distanceOf(const PosePair& pair) {
  return (pair.T_W_estimate.translation() - pair.T_W_truth.translation()).norm();
}

cv::Scalar errorColor(double fraction) {
  cv::Mat color(1, 1, CV_8UC1, cv::Scalar(std::clamp(255.0 * fraction, 0.0, 255.0)));
  cv::applyColorMap(color, color, cv::COLORMAP_TURBO);
  return cv::Scalar(color.at<cv::Vec3b>(0, 0));
}

// Draws one view in its square of the canvas, with equal scale on both axes.
class Panel {
 public:
  Panel(cv::Mat& canvas, const cv::Point& corner, const View& view, const std::vector<PosePair>& pairs,
        double extent_m)
      : canvas_(canvas),
        frame_(corner + cv::Point(kMargin_px, 0), cv::Size(kPanel_px, kPanel_px)),
        view_(view),
        pairs_(pairs),
        extent_m_(extent_m) {
    for (const int axis : {view.horizontal, view.vertical}) {
      const Range range = rangeOf(pairs, axis);
      low_m_[axis] = (range.low + range.high - extent_m) / 2.0;
    }
  }

  void draw(double max_error_m) {
    drawAxis(view_.horizontal, true);
    drawAxis(view_.vertical, false);
    cv::rectangle(canvas_, frame_, kInk, 1, cv::LINE_AA);
    writeCentred(canvas_, view_.title, cv::Point(frame_.x + frame_.width / 2, frame_.y - 14));
    for (size_t i = 1; i < pairs_.size(); ++i) {
      drawSegment(pairs_[i - 1].T_W_truth, pairs_[i].T_W_truth, kTruth, 4);
    }
    for (size_t i = 1; i < pairs_.size(); ++i) {
      drawSegment(pairs_[i - 1].T_W_estimate, pairs_[i].T_W_estimate,
                  errorColor(distanceOf(pairs_[i]) / max_error_m), 2);
    }
    cv::circle(canvas_, pixelOf(pairs_.front().T_W_truth), 6 << kSubpixelBits, kInk, 2, cv::LINE_AA,
               kSubpixelBits);
  }

 private:
  void drawAxis(int axis, bool horizontal) {
    const double step_m = niceStep(extent_m_);
    const char* format = step_m < 0.01 ? "%.3f" : step_m < 0.1 ? "%.2f" : "%.1f";
    for (double tick = std::ceil(low_m_[axis] / step_m); tick * step_m <= low_m_[axis] + extent_m_; ++tick) {
      const int offset = static_cast<int>((tick * step_m - low_m_[axis]) / extent_m_ * kPanel_px);
      const std::string label = number(format, tick == 0.0 ? 0.0 : tick * step_m);
      if (horizontal) {
        const int x = frame_.x + offset;
        cv::line(canvas_, {x, frame_.y}, {x, frame_.br().y}, kGrid, 1);
        writeCentred(canvas_, label, {x, frame_.br().y + 16});
      } else {
        const int y = frame_.br().y - offset;
        cv::line(canvas_, {frame_.x, y}, {frame_.br().x, y}, kGrid, 1);
        writeCentred(canvas_, label, {frame_.x - 30, y});
      }
    }
    const std::string name = std::string(1, "xyz"[axis]) + " [m]";
    writeCentred(canvas_, name,
                 horizontal ? cv::Point(frame_.x + kPanel_px / 2, frame_.br().y + 40)
                            : cv::Point(frame_.x - 30, frame_.y - 14));
  }

  void drawSegment(const Pose& from, const Pose& to, const cv::Scalar& color, int thickness) {
    cv::line(canvas_, pixelOf(from), pixelOf(to), color, thickness, cv::LINE_AA, kSubpixelBits);
  }

  cv::Point pixelOf(const Pose& T_W_D) const {
    const double scale = kPanel_px / extent_m_;
    const double x = frame_.x + (T_W_D.translation()[view_.horizontal] - low_m_[view_.horizontal]) * scale;
    const double y = frame_.br().y - (T_W_D.translation()[view_.vertical] - low_m_[view_.vertical]) * scale;
    return cv::Point(cv::Point2d(x, y) * (1 << kSubpixelBits));
  }

  cv::Mat& canvas_;
  cv::Rect frame_;
  View view_;
  const std::vector<PosePair>& pairs_;
  double extent_m_;
  double low_m_[3] = {0.0, 0.0, 0.0};
};

void drawColorBar(cv::Mat& canvas, const cv::Rect& bar, double max_error_m) {
  for (int row = 0; row < bar.height; ++row) {
    const int y = bar.br().y - 1 - row;
    cv::line(canvas, {bar.x, y}, {bar.br().x, y}, errorColor(static_cast<double>(row) / bar.height), 1);
  }
  cv::rectangle(canvas, bar, kInk, 1);
  for (int tick = 0; tick <= 4; ++tick) {
    const int y = bar.br().y - bar.height * tick / 4;
    writeText(canvas, number("%.3g", max_error_m * 1000.0 * tick / 4), {bar.br().x + 8, y + 5});
  }
  writeText(canvas, "error [mm]", {bar.x - 15, bar.y - 14});
}

std::string titleOf(const TrajectoryError& error) {
  return number("Trajectory error: ATE RMSE %.3g mm", error.ate_m.rmse * 1000.0) +
         number(", median %.3g mm", error.ate_m.median * 1000.0) +
         number(", max %.3g mm", error.ate_m.max * 1000.0) + ", " + std::to_string(error.pairs.size()) +
         " poses";
}

}  // namespace

cv::Mat plotTrajectories(const TrajectoryError& error) {
  check(!error.pairs.empty(), "there are no poses to plot");
  double extent_m = 1e-3;
  for (int axis = 0; axis < 3; ++axis) {
    const Range range = rangeOf(error.pairs, axis);
    extent_m = std::max(extent_m, 1.1 * (range.high - range.low));
  }
  const int panel_width = kMargin_px + kPanel_px;
  cv::Mat canvas(kHeader_px + kPanel_px + kMargin_px, 2 * panel_width + kColorBar_px + 30, CV_8UC3,
                 cv::Scalar::all(255));
  const double max_error_m = std::max(error.ate_m.max, 1e-6);
  const View views[] = {{"top view", 0, 1}, {"side view", 0, 2}};
  for (int i = 0; i < 2; ++i) {
    Panel(canvas, {i * panel_width, kHeader_px}, views[i], error.pairs, extent_m).draw(max_error_m);
  }
  drawColorBar(canvas, {2 * panel_width + 35, kHeader_px, 20, kPanel_px}, max_error_m);
  writeText(canvas, titleOf(error), {kMargin_px, 28}, 0.6);
  writeText(canvas, "grey: ground truth   coloured: estimate   circle: start",
            {kMargin_px, canvas.rows - 14});
  return canvas;
}

}  // namespace depth_fusion
