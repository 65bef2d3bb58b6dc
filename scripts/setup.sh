# Sourced by fly and test: installs what is missing and says so. Asks nothing.
# Afterwards .venv/bin/python has quadcore as it lies in this checkout.

apt_packages="g++ make cmake ninja-build pkg-config python3-dev python3-venv
  libode-dev libeigen3-dev libtinyxml2-dev doctest-dev ${extra_apt_packages:-}"
python_packages="scikit-build-core>=0.5 pybind11>=2.10 numpy scipy matplotlib rich xacro rospkg
  jinja2 pytest hypothesis ruff mypy clang-format==23.1.5"

say() { echo "quadcore: $*"; }

install_apt_packages() {
  local missing="" package install
  for package in $apt_packages; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
      missing="$missing $package"
  done
  [ -z "$missing" ] && return
  install="apt-get install -y --no-install-recommends$missing"
  if [ "$(id -u)" = 0 ]; then
    as_root=""
  elif sudo -n true 2>/dev/null; then
    as_root="sudo -n"
  else
    say "these packages are missing and need root; run" >&2
    say "    sudo apt-get update && sudo $install" >&2
    exit 2
  fi
  say "installing with apt:$missing"
  $as_root apt-get -qq update
  $as_root env DEBIAN_FRONTEND=noninteractive $install >/dev/null
}

# The interpreter of the distribution, because that is the one for which ROS' packages are built.
create_venv() {
  [ -x .venv/bin/python ] || {
    say "creating a virtual environment in .venv"
    /usr/bin/python3 -m venv --system-site-packages .venv
  }
  local wanted
  wanted=$(echo "$python_packages" | sha256sum)
  [ "$(cat .venv/packages.sha256 2>/dev/null)" = "$wanted" ] && return
  say "installing with pip:" $python_packages
  .venv/bin/python -m pip install --quiet --upgrade pip
  .venv/bin/python -m pip install --quiet $python_packages
  echo "$wanted" > .venv/packages.sha256
}

install_quadcore() {
  local sources
  sources=$(find CMakeLists.txt pyproject.toml cpp python urdf worlds config launch srv \
    -type f -not -name '*.pyc' -print0 | sort -z | xargs -0 sha256sum | sha256sum)
  [ "$(cat .venv/quadcore.sha256 2>/dev/null)" = "$sources" ] && return
  say "building and installing quadcore into .venv"
  .venv/bin/python -m pip install --quiet --no-build-isolation --no-deps --force-reinstall .
  echo "$sources" > .venv/quadcore.sha256
}

# A Python of somebody else's (conda, pyenv) must not lend its packages.
unset PYTHONPATH PYTHONHOME
install_apt_packages
create_venv
install_quadcore
