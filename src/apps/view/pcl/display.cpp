#include "apps/view/pcl/display.h"

#include "depth_fusion/common/error.h"
// The last one, for its macros have the names of others' functions.
#include <X11/Xlib.h>

namespace depth_fusion {

void checkDisplay() {
  // It stays open: the server would begin anew, and be away for a moment, when its last client left.
  static const Display* display = XOpenDisplay(nullptr);
  check(display != nullptr,
        "there is no display to open a window on; set DISPLAY, or run it as: xvfb-run scripts/run view ...");
}

}  // namespace depth_fusion
