// The window that a model is shown in.
#pragma once

#include <functional>
#include <string>

#include "apps/view/model.h"

namespace depth_fusion {

struct WindowOptions {
  std::string model;
  std::string paint = "texture";
  std::string view = "auto";
  std::string screenshot;  // a picture in place of a window; empty: none
  int width = 1280, height = 960;
  bool behind = false;  // show what is seen from behind
  bool without_way = false;
  bool follow = false;  // read the model again when its file has changed
};

// Shows what `read` gives until the user closes the window, or writes the picture. Throws Error if
// there is no display, and what `read` throws at first.
void showWindow(const WindowOptions& options, const std::function<ViewedModel()>& read);

}  // namespace depth_fusion
