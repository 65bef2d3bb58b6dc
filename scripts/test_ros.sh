#!/usr/bin/env bash
# Builds a catkin workspace in build/catkin and runs every test of tests/ros in its devel space, and
# some once more in its install space. Where ROS 1 is not there it says so in one line and succeeds;
# with --with-ros it is installed, and its lack a failure.
# Needs .venv, which scripts/test makes, for xacro where the distribution has none.
set -euo pipefail
cd "$(dirname "$0")/.."

say() { echo "quadcore: $*"; }
# Where they were asked for it is a failure.
skip() { say "ROS tests skipped: $*"; [ "$asked" = no ]; exit; }
asked=no
[ "${1:-}" = --with-ros ] && asked=yes

# What docs/ros.md has its reader install, so that a package that it lacks is missing here, too.
page_packages() {
  sed -n '/^sudo apt-get install .* git /,/[^\\]$/p' docs/ros.md | tr -d '\\\n' | sed 's/.*-recommends//'
}
debian_packages="$(page_packages) librostest-dev python3-rostest"
noetic_packages="ros-noetic-ros-base ros-noetic-rostest ros-noetic-tf2-msgs ros-noetic-diagnostic-msgs
  ros-noetic-nav-msgs ros-noetic-sensor-msgs ros-noetic-std-srvs ros-noetic-trajectory-msgs
  ros-noetic-visualization-msgs ros-noetic-dynamic-reconfigure ros-noetic-roslz4 ros-noetic-xacro
  pybind11-dev python3-dev python3-numpy python3-scipy python3-setuptools"

as_root() {
  if [ "$(id -u)" = 0 ]; then env DEBIAN_FRONTEND=noninteractive "$@"
  else sudo -n env DEBIAN_FRONTEND=noninteractive "$@"; fi
}
may_be_root() { [ "$(id -u)" = 0 ] || sudo -n true 2>/dev/null; }
known() { apt-cache show "$1" >/dev/null 2>&1; }

install_ros() {
  local packages missing="" package
  known libroscpp-dev || known ros-noetic-ros-base || [ $asked = no ] || ! may_be_root ||
    as_root apt-get -qq update
  if [ -d /opt/ros/noetic ] || known ros-noetic-ros-base; then packages=$noetic_packages
  elif known libroscpp-dev; then packages=$debian_packages
  else skip "apt knows no packages of ROS 1"; fi
  for package in $packages; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
      missing="$missing $package"
  done
  [ -z "$missing" ] && return
  [ $asked = yes ] || skip "packages of ROS are missing; scripts/test --with-ros installs them"
  local install="apt-get install -y --no-install-recommends$missing"
  may_be_root || skip "packages are missing and need root; run: sudo $install"
  say "installing with apt:$missing"
  as_root apt-get -qq update
  as_root $install >/dev/null || skip "apt could not install them"
}

# A copy, because links back to here would send the ROS tools, which follow them, round in circles.
copy_sources() {
  rm -rf $workspace/src/quadcore
  mkdir -p $workspace/src/quadcore/tests
  cp -rp CMakeLists.txt LICENSE README.md package.xml pyproject.toml setup.py cpp python launch msg srv \
    urdf worlds config docs scripts web examples $workspace/src/quadcore
  cp -rp tests/ros $workspace/src/quadcore/tests
  # Messages of others that the distribution lacks.
  local package
  for package in cpp/ros/packages/*/; do
    rm -rf $workspace/src/$(basename $package)
    [ -d /opt/ros/noetic/share/$(basename $package) ] || cp -rp $package $workspace/src
  done
}

build() {
  local options=("-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG -Wno-error=maybe-uninitialized")
  # The workspace links the core of scripts/test, so that only the nodes and bindings are compiled.
  if [ -e build/tests/build.ninja ]; then
    cmake --build build/tests >$workspace/build.log 2>&1 ||
      { tail -n 40 $workspace/build.log; say "build/tests does not build"; exit 1; }
    options+=("-DQUADCORE_OBJECTS_OF=$PWD/build/tests")
  fi
  # Told how many jobs, catkin does not wait for others to leave the processor. Only C++ and Python use
  # the messages.
  ROS_LANG_DISABLE=geneus:genlisp:gennodejs \
    catkin_make -C $workspace "-j$(nproc)" -DPYTHON_EXECUTABLE=/usr/bin/python3 -DQUADCORE_WITH_ROS=ON \
    -DQUADCORE_WERROR=ON -DCMAKE_UNITY_BUILD=ON "${options[@]}" -DCMAKE_POLICY_VERSION_MINIMUM=3.5 \
    install >$workspace/build.log 2>&1 ||
    { tail -n 40 $workspace/build.log; say "the catkin workspace does not build"; exit 1; }
  # Found in the install space like the tests of any package that installs its own.
  mkdir -p $workspace/install/share/quadcore/tests
  cp -rp tests/ros $workspace/install/share/quadcore/tests
}

# Plugins by others, which find quadcore in the space they are built in.
build_plugins() {
  local source folder
  export QUADCORE_PLUGIN_PATH=""
  for source in examples/side_force_plugin tests/plugins/relay; do
    folder=$workspace/$1-$(basename $source)
    { cmake -S $source -B $folder && cmake --build $folder; } >$folder.log 2>&1 ||
      { cat $folder.log; say "$source does not build in the $1 space"; exit 1; }
    QUADCORE_PLUGIN_PATH="$PWD/$folder:$QUADCORE_PLUGIN_PATH"
  done
}

# report SPACE SUITE: says how it went; all that it printed if it did not go well.
report() {
  local log=$workspace/$1-$2.log count
  count=$(sed -n 's/^ \* TESTS: //p' $log)
  if grep -q 'RESULT: SUCCESS' $log && [ "$count" -gt 0 ]; then
    say "  $1 $2: $count passed"
  else
    cat $log
    say "  $1 $2: FAILED"
    touch $workspace/failed
  fi
}

# run_suites SPACE SUITE...: one by its launch file; several, which start their nodes themselves, one
# after the other under one master, because a master and the imports take longer than many a suite.
run_suites() {
  local space=$1 name
  shift
  for name in "$@"; do : >$workspace/$space-$name.log; done
  if [ $# = 1 ]; then
    rostest --text quadcore "$1.test" >$workspace/$space-$1.log 2>&1 || true
  else
    rostest --text quadcore suites.test "suites:=$PWD/$workspace/$space- $*" \
      >$workspace/$space-suites-with-$1.log 2>&1 || cat $workspace/$space-suites-with-$1.log
  fi
  for name in "$@"; do report $space $name; done
}

# run_in SPACE SUITES...: the suites of each argument, some at a time, with the environment of that space.
run_in() {
  local space=$1 suites
  shift
  set +u
  . $workspace/$space/setup.bash
  set -u
  build_plugins $space
  # Debian's packages lie where no setup.bash looks, and xacro is not among them.
  [ -d /opt/ros/noetic ] || export ROS_PACKAGE_PATH="$ROS_PACKAGE_PATH:/usr/share" \
    PYTHONPATH="$PYTHONPATH:$PWD/$workspace/xacro"
  for suites in "$@"; do
    while [ "$(jobs -rp | wc -l)" -ge $((3 * $(nproc))) ]; do wait -n; done  # they wait a lot
    run_suites $space $suites &
  done
  wait
}

workspace=build/catkin
mkdir -p $workspace
rm -f $workspace/failed
install_ros
# The nodes written in Python run on the system's, with quadcore from the workspace and nothing of
# .venv, except xacro where the distribution has none.
export PATH="/usr/bin:$PATH"
rm -rf $workspace/xacro
mkdir -p $workspace/xacro
cp -r .venv/lib/python3*/site-packages/xacro $workspace/xacro
if [ -d /opt/ros/noetic ]; then set +u; . /opt/ros/noetic/setup.bash; set -u; fi
# But what reads bags without ROS runs there.
export QUADCORE_COMMAND="$PWD/.venv/bin/quadcore"
export ROS_HOME="$PWD/$workspace/ros_home"

say "building a catkin workspace in $workspace"
trap 'rm -rf $workspace/src/quadcore' EXIT
copy_sources
build
say "running the ROS tests"
SECONDS=0
(run_in devel several rotors_hover rotors "playing logs log_per_flight lee" "masters lockstep services" \
  "faults clock topics one_world" "controller controller_faults set_points" "parameters disturbances refusals" \
  launch hector mrs pid "tools alarms waiting gazebo" "pages joystick" "tutorial building" fly_from_python \
  gazebo_launch gazebo_tutorial links "plugin_topics plugin_by_others sensors markers rotors_topics vehicles")
(run_in install launch "playing plugin_by_others" fly_from_python)
[ ! -e $workspace/failed ]
say "the ROS tests passed in $SECONDS s"
