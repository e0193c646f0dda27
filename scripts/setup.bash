# Sourced by the scripts: finds the repository (ROOT), installs what is missing, builds in ROOT/build (BUILD).

set -euo pipefail

ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)"
BUILD="$ROOT/build"

# catkin runs the first python3 on the PATH; only the system's has catkin's modules.
export PATH="/usr/bin:$PATH"
unset PYTHONHOME PYTHONPATH

# What the rosdep keys of package.xml do not bring: tools, a CPU device for OpenCL, one that checks kernels, and
# what draws plots, and what map files and servers need. The tests start a PostgreSQL server of their own; scripts/check
# has use for clang-format 14 only, which is Debian 12's. The viewer is tested on a screen in memory.
TOOL_PACKAGES=(build-essential cmake pocl-opencl-icd oclgrind python3-matplotlib liblmdb-dev libzstd-dev libpq-dev)
CHECK_PACKAGES=(clang-format clang-tidy postgresql xvfb xauth libfcl-dev libompl-dev libtinygltf-dev)
ROS_TOOL_PACKAGES=(python3-rosdep python3-catkin-lint)
# Debian carries ROS 1 itself, under its own names.
DEBIAN_PACKAGES=(
  catkin catkin-lint libgtest-dev
  ros-message-generation ros-message-runtime ros-geometry-msgs ros-std-msgs
  libroscpp-dev libroscpp-core-dev pluginlib-dev libnodelet-dev libnodeletlib-dev libnodeletlib-tools libdiagnostic-updater-dev
  libdynamic-reconfigure-config-init-mutex-dev python3-dynamic-reconfigure
  libcamera-info-manager-dev libimage-transport-dev libopenni2-dev
  librosbag-storage-dev libtf2-ros-dev libtf2-msgs-dev tf2-tools
  libstd-msgs-dev libsensor-msgs-dev libgeometry-msgs-dev libmap-msgs-dev libnav-msgs-dev libvisualization-msgs-dev libdiagnostic-msgs-dev
  libstd-srvs-dev libros-rosgraph-msgs-dev
  python3-std-srvs python3-diagnostic-msgs python3-geometry-msgs python3-nav-msgs python3-sensor-msgs
  librostest-dev python3-rostest python3-roslaunch python3-rosbag python3-rosservice python3-rostopic rosbash rosout rospack-tools rviz
  libeigen3-dev libceres-dev liboctomap-dev libopencv-dev libyaml-cpp-dev libcli11-dev nlohmann-json3-dev libmeshoptimizer-dev libpcl-dev libassimp-dev
  ocl-icd-opencl-dev opencl-headers libbenchmark-dev
)

say() { echo "== $*" >&2; }

fail() {
  echo "error: $*" >&2
  exit 1
}

as_root() {
  if [[ $(id -u) -eq 0 ]]; then "$@"; else sudo "$@"; fi
}

may_be_root() { [[ $(id -u) -eq 0 ]] || command -v sudo >/dev/null; }

# The given packages that are not installed, one a line.
missing_packages() {
  local installed
  installed="$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "$@" 2>/dev/null | sed -n "s/ installed$//p")" || true
  printf '%s\n' "$@" | grep -vxF "$installed" || true
}

# A package that cannot be had is no error here: whether the build can do without it, its configuration says.
install_packages() {
  local missing
  mapfile -t missing < <(missing_packages "$@")
  [[ ${#missing[@]} -gt 0 ]] || return 0
  local by_hand="if the build fails, let root run: apt-get install ${missing[*]}"
  if ! may_be_root; then
    say "missing packages, and neither root nor sudo to install them; $by_hand"
    return 0
  fi
  say "installing with apt-get (this may take minutes): ${missing[*]}"
  as_root apt-get update -qq || say "apt-get update failed; going on with the package lists as they are"
  as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null ||
    say "could not install all of them; $by_hand"
}

install_ros_dependencies() {
  local rosdep_arguments=(--from-paths "$ROOT" --ignore-src --rosdistro "$ROS_DISTRO")
  if rosdep check "${rosdep_arguments[@]}" >/dev/null 2>&1; then return; fi
  say "installing the dependencies of package.xml with rosdep"
  compgen -G '/etc/ros/rosdep/sources.list.d/*.list' >/dev/null || as_root rosdep init || true
  rosdep update --include-eol-distros --rosdistro "$ROS_DISTRO" >/dev/null || true
  as_root apt-get update -qq || true
  rosdep install -y "${rosdep_arguments[@]}" ||
    say "rosdep could not install all of them; if the build fails, install the dependencies of package.xml by hand"
}

# Sources the newest ROS 1 below /opt/ros, if there is one.
source_ros() {
  local folder found=""
  for folder in /opt/ros/*; do
    if [[ -e $folder/setup.bash && -e $folder/share/catkin ]]; then found="$folder"; fi
  done
  [[ -n $found ]] || return 1
  source_environment "$found/setup.bash"
}

# The set-up files of catkin read variables that are not set, and the arguments of who sources them.
source_environment() {
  local file="$1"
  set --
  set +u
  # shellcheck disable=SC1090
  source "$file"
  set -u
}

install_dependencies() {
  if ! command -v apt-get >/dev/null; then
    say "no apt-get here; needed are (by Debian's names): ${TOOL_PACKAGES[*]} ${DEBIAN_PACKAGES[*]}"
    source_ros || true
  elif source_ros; then
    install_packages "${TOOL_PACKAGES[@]}" "${ROS_TOOL_PACKAGES[@]}"
    install_ros_dependencies
  else
    install_packages "${TOOL_PACKAGES[@]}" "${DEBIAN_PACKAGES[@]}"
  fi
}

# ROS's tools speak to themselves over the network: they want a name of this machine that resolves, which a bare container need
# not have.
prepare_ros_network() {
  export ROS_HOSTNAME=localhost
  if getent hosts localhost >/dev/null; then return; fi
  say "localhost does not resolve; adding it to /etc/hosts"
  echo "127.0.0.1 localhost" | as_root tee -a /etc/hosts >/dev/null || say "could not write /etc/hosts; ROS will not start"
}

# Prepares the build, with the given options of CMake; what an earlier call has set, stays.
configure() {
  local log="$BUILD/configure.log"
  mkdir -p "$BUILD"
  cmake -S "$ROOT" -B "$BUILD" -DCATKIN_ENABLE_TESTING=ON -DPYTHON_EXECUTABLE=/usr/bin/python3 "$@" >"$log" 2>&1 ||
    { cat "$log" >&2; fail "the build cannot be configured; the reason stands above"; }
}

# Builds the given CMake targets.
build() {
  say "building in $BUILD"
  cmake --build "$BUILD" --parallel "$(nproc)" --target "$@"
}

list_apps() { (cd "$ROOT/src/apps" && printf '%s\n' *.cpp | sed 's/\.cpp$//'); }

app_path() { echo "$BUILD/devel/lib/depth_fusion/$1"; }
