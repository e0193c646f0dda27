// Poses and exposures of pictures, refined until they agree on the colours of the surface.
#pragma once

#include <functional>
#include <vector>

#include "texturing/view_image.h"

namespace depth_fusion {

struct Alignment {
  double misfit_before = 0.0, misfit_after = 0.0;  // see TexturingReport
  double move_m = 0.0;
};

// Moves the views and sets their gains. In turn, the surface's points get the mean colour of the pictures
// that see them, and each picture is moved until it shows them so. Points at depth edges are left out. The
// poses as they came are the prior.
Alignment alignViews(const TriangleMesh& mesh, std::vector<ChosenView>& views,
                     const TexturingParameters& parameters, const std::function<void(double)>& progress);

}  // namespace depth_fusion
