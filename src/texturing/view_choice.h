// Which of the pictures the texture is made of.
#pragma once

#include <vector>

#include "texturing/view_image.h"

namespace depth_fusion {

// Chooses sharp pictures that are spread: the sharpest first, no other near it, and so on; if they are too
// many, farther apart.
std::vector<ChosenView> chosenViews(std::vector<TexturingView> views, const TexturingParameters& parameters);

}  // namespace depth_fusion
