#include "depth_fusion/submaps/submap_parameters.h"

namespace depth_fusion {

ParameterTable SubmapParameters::table() {
  return atStartOnly(
      {number("memory_mib", &memory_mib, 1, 1048576,
              "memory for blocks that are not in the pool, compressed; what is over it goes to the store"),
       number("disk_mib", &disk_mib, 1, 1073741824, "what the store takes at most"),
       text("store", &store,
            "where blocks go that memory does not hold: a folder, or an address postgresql://...; empty: the "
            "system's folder for temporary files. It is of use to this map alone"),
       number("drift", &drift, 0.0, 1.0,
              "how far off a tracked pose may be, as a part of the way since a submap was left"),
       number("sure_m", &sure_m, 0.0, 10.0,
              "a submap is gone on with if the poses are surely no farther off than this"),
       number("max_length_m", &max_length_m, 0.0, 1e6,
              "a submap also ends after so much of the sensor's way; 0: only where the sensor leaves it")});
}

}  // namespace depth_fusion
