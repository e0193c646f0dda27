// In place of the window where depth_fusion was built without PCL's visualization.
#include "apps/view/window.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr char kMissing[] =
    "this depth_fusion was built without PCL's visualization or assimp, which show and read models; install "
    "libpcl-dev and libassimp-dev, and build again";

}  // namespace

void showWindow(const WindowOptions&, const std::function<ViewedModel()>&) { throw Error(kMissing); }

TriangleMesh readByPcl(const std::string&) { throw Error(kMissing); }

ViewedModel readByAssimp(const std::string&) { throw Error(kMissing); }

}  // namespace depth_fusion
