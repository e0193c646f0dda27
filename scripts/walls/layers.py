"""Where the walls stand: the floors of the house, who may visit whom, and what the core may use of others."""
import re

# A folder includes folders of lower floors only, and on its own floor only data headers (see is_data).
FLOORS = [
    ["kernels"],
    ["common"],
    ["geometry", "store"],
    ["compute"],
    ["frames"],
    ["map", "recording"],
    ["registration", "masking", "preprocessing", "texture_odometry", "robot_motion", "tsdf_fusion", "color_fusion", "model_view",
     "icp_tracking", "relocalisation", "surface_mesh", "esdf", "acquisition"],
    ["loops", "texturing"],
    ["submaps"],
    ["pipeline"],
    ["tools/simulation"],
    ["tools/evaluation", "tools/calibration"],
    ["tools/plots"],
    ["tools/report"],
    ["ros/callbacks", "ros/conversions"],
    ["ros/parameters"],
    ["ros/bags"],
    ["ros/in_process"],
    ["ros/input", "ros/output"],
    ["ros/nodelets"],
    ["apps"],
]

# Visits on one floor that the rule would forbid: (file, header): reason.
EXCEPTIONS = {
    ("src/color_fusion/color_fusion_kernels.h", "registration/depth_splat_kernels.h"):
        "colour sees the depth image from the colour camera by the same two kernels",
    ("src/model_view/mesh_renderer.h", "surface_mesh/surface_mesh_kernels.h"):
        "the second renderer draws the triangles that marching cubes makes",
}

# What the core may include that is not its own: the standard library, POSIX, and these libraries. All else, and so
# whatever ROS has, is outside: Debian's ROS lies in /usr/include, where the compiler would find it.
CORE_LIBRARIES = re.compile(
    r"[a-z_]+$|(unistd|fcntl)\.h$|sys/|Eigen/|opencv2/|CL/|yaml-cpp/|ceres/|octomap/|OpenNI\.h$|meshoptimizer\.h$|(lmdb|zstd|libpq-fe)\.h$"
)
# What only the workshop and the apps have, so that a robot's build needs it not.
WORKSHOP_LIBRARIES = re.compile(r"CLI/|nlohmann/|benchmark/")
# Of the core's, what public headers keep to themselves, so that whoever uses the core needs it not.
PRIVATE_LIBRARIES = re.compile(r"CL/|yaml-cpp/|ceres/|octomap/|OpenNI\.h$|meshoptimizer\.h$|(lmdb|zstd|libpq-fe)\.h$")

# What travels between stages, and between nodelets.
TRAVELS = ("include/depth_fusion/frames/", "src/ros/in_process/frames.h", "src/ros/in_process/process_message.h")

# What data headers may include of ours, beside other data headers.
DATA_FLOORS = ("kernels", "common", "geometry", "compute", "frames")


def folder_of(path):
    """The room that a file lies in: its stage, or its room of ros or tools."""
    parts = path.split("/")[:-1]
    if parts[0] == "kernels":
        return "kernels"
    parts = parts[2:] if parts[0] == "include" else parts[1:]
    if not parts:
        return "."
    return "/".join(parts[:2]) if parts[0] in ("ros", "tools") else parts[0]


def floor_of(folder):
    return next((i for i, folders in enumerate(FLOORS) if folder in folders), None)


def is_core(path):
    return path.startswith(("include/", "src/")) and not path.startswith(("src/ros/", "src/apps/"))


def is_data(path):
    """A header of what travels, or of what a stage or a nodelet is told."""
    return path.startswith(TRAVELS) or path.endswith("_parameters.h")
