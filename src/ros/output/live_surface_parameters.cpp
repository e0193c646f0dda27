#include "ros/output/live_surface_parameters.h"

namespace depth_fusion {

ParameterTable LiveSurfaceParameters::table() {
  return {number("chunk_blocks", &chunk_blocks, 1, 256,
                 "edge of the chunks in which the surface is published, in blocks"),
          number("chunks_per_update", &chunks_per_update, 1, 10000,
                 "chunks published at a time at most; those near the camera come first"),
          number("refresh_chunks", &refresh_chunks, 0, 10000,
                 "chunks that did not change, published once more at each update that has room, in turn, for "
                 "viewers that joined another of their process, or whose own queue is short; 0 = none"),
          number("triangle_share", &triangle_share, 0.001, 1.0,
                 "part of a chunk's triangles that its marker keeps, flat ones first to go; all, if built "
                 "without meshoptimizer"),
          number("max_bandwidth_mb_s", &max_bandwidth_mb_s, 0.1, 1000.0,
                 "MB/s to each viewer at most: while more than that changes, chunks are simplified, and come "
                 "whole when less does"),
          number("point_spacing_m", &point_spacing_m, 0.0, 10.0,
                 "edge of the cubes that have one point each; 0 = all vertices")};
}

}  // namespace depth_fusion
