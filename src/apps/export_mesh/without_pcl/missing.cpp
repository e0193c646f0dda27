// In place of what needs PCL where depth_fusion was built without it.
#include "apps/export_mesh/object.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr char kMissing[] =
    "this depth_fusion was built without PCL, which finds the ground and closes models; install libpcl-dev "
    "and build again";

}  // namespace

Eigen::Vector4f groundOf(const TriangleMesh&) { throw Error(kMissing); }

TriangleMesh closedModel(const TriangleMesh&) { throw Error(kMissing); }

}  // namespace depth_fusion
