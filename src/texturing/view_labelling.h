// Which picture each face gets.
#pragma once

#include "texturing/face_neighbours.h"
#include "texturing/face_views.h"

namespace depth_fusion {

// Returns a view for each face, kNoView where none shows it: the sum over faces of what their picture lacks
// of the best one, and over edges between different pictures of `smoothness`, is small. By belief propagation
// on the faces' graph.
std::vector<uint16_t> labelFaces(const std::vector<FaceViews>& faces, const FaceNeighbours& neighbours,
                                 float smoothness);

}  // namespace depth_fusion
