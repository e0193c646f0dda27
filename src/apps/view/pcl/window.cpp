#include "apps/view/window.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "apps/view/pcl/display.h"
#include "apps/view/pcl/scene.h"
#include "common/io/image_file.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

using pcl::visualization::KeyboardEvent;
using pcl::visualization::MouseEvent;

constexpr double kFlight_s = 20.0;  // along the whole way
constexpr int kSpin_ms = 20;
constexpr auto kFollowPeriod = std::chrono::milliseconds(300);

using FileTime = std::filesystem::file_time_type;

class Window {
 public:
  Window(const WindowOptions& options, const std::function<ViewedModel()>& read)
      : options_(options),
        read_(read),
        shown_change_(changeTime()),
        model_(read()),
        scene_(options),
        shown_{"", options.behind, !options.without_way} {
    choosePaint();
    show();
    scene_.lookFrom(options.view, model_.mesh);
  }

  void writeScreenshot() { writePicture(options_.screenshot, scene_.picture()); }

  void run() {
    scene_.viewer().registerKeyboardCallback([this](const KeyboardEvent& event) { onKey(event); });
    scene_.viewer().registerMouseCallback([this](const MouseEvent& event) { onMouse(event); });
    auto next_look = std::chrono::steady_clock::now();
    while (!scene_.viewer().wasStopped()) {
      scene_.viewer().spinOnce(kSpin_ms);
      if (flight_s_ >= 0.0) fly();
      if (!options_.follow || std::chrono::steady_clock::now() < next_look) continue;
      follow();
      next_look = std::chrono::steady_clock::now() + kFollowPeriod;
    }
  }

 private:
  // The mesh was written then; the earliest time there is if there is none.
  FileTime changeTime() const {
    const std::filesystem::path path = options_.model;
    std::error_code none;
    const FileTime time = std::filesystem::last_write_time(
        std::filesystem::is_directory(path) ? path / "mesh.ply" : path, none);
    return none ? FileTime::min() : time;
  }

  // Shows the model anew if it has changed, all of it until the user has taken the mouse.
  void follow() {
    const FileTime change = changeTime();
    if (change == shown_change_ || change == FileTime::min()) return;
    shown_change_ = change;
    model_ = read_();
    choosePaint();
    show();
    if (!is_turned_) scene_.lookFrom(options_.view, model_.mesh);
  }

  void choosePaint() {
    const std::vector<std::string> paints = paintsOf(model_);
    const auto paint = std::find(paints.begin(), paints.end(), wanted_paint_);
    shown_.paint = paint == paints.end() ? paints.front() : *paint;
  }

  void show() { scene_.show(model_, shown_, ruler_); }

  void fly() {
    const double share = std::min(flight_s_ / kFlight_s, 1.0);
    const auto pose = static_cast<size_t>(share * static_cast<double>(model_.way.size() - 1));
    scene_.look(model_.way[pose].T_W_D, 1.0);
    flight_s_ = share < 1.0 ? flight_s_ + 1e-3 * kSpin_ms : -1.0;
  }

  void onKey(const KeyboardEvent& event) {
    if (!event.keyDown()) return;
    const std::string key = event.getKeySym();
    if (key == "v") flight_s_ = flight_s_ < 0.0 && model_.way.size() > 1 ? 0.0 : -1.0;
    if (key == "m") ruler_.clear();
    if (key == "t") shown_.way = !shown_.way;
    if (key == "b") shown_.behind = !shown_.behind;
    if (key == "n") {
      const std::vector<std::string> paints = paintsOf(model_);
      const auto next = std::find(paints.begin(), paints.end(), shown_.paint) + 1;
      wanted_paint_ = shown_.paint = next == paints.end() ? paints.front() : *next;
    }
    if (key == "m" || key == "t" || key == "b" || key == "n") show();
  }

  void onMouse(const MouseEvent& event) {
    is_turned_ = is_turned_ || event.getType() == MouseEvent::MouseButtonPress ||
                 event.getType() == MouseEvent::MouseScrollUp ||
                 event.getType() == MouseEvent::MouseScrollDown;
    if (event.getType() != MouseEvent::MouseButtonPress || event.getButton() != MouseEvent::LeftButton ||
        (event.getKeyboardModifiers() & KeyboardEvent::Shift) == 0)
      return;
    const auto point_W = scene_.pointAt(static_cast<int>(event.getX()), static_cast<int>(event.getY()));
    if (!point_W) return;
    ruler_.pick(*point_W);
    show();
    std::printf("%s\n", ruler_.text().c_str());
    std::fflush(stdout);
  }

  const WindowOptions& options_;
  const std::function<ViewedModel()> read_;
  FileTime shown_change_;  // of the model that is shown
  ViewedModel model_;
  ModelScene scene_;
  SceneOptions shown_;
  std::string wanted_paint_ = options_.paint;
  bool is_turned_ = false;  // by the user
  Ruler ruler_;
  double flight_s_ = -1.0;  // since it began; negative: none
};

}  // namespace

void showWindow(const WindowOptions& options, const std::function<ViewedModel()>& read) {
  checkDisplay();
  vtkObject::GlobalWarningDisplayOff();  // PCL calls what VTK is about to drop, and VTK says so each time
  Window window(options, read);
  if (options.screenshot.empty())
    window.run();
  else
    window.writeScreenshot();
}

}  // namespace depth_fusion
