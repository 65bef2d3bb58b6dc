# Sourced by wheels and try_wheels: runs commands in bare Debians in folders. Needs root.

systems=${QUADCORE_SYSTEMS:-build/systems}
mirror=http://deb.debian.org/debian
# Their Pythons: 3.9, 3.11, 3.13.
suites="bullseye bookworm trixie"

say() { echo "quadcore: $*"; }

need_root() {
  [ "$(id -u)" = 0 ] || { say "bare systems need root; run sudo $0" >&2; exit 2; }
  command -v debootstrap >/dev/null ||
    { say "there is no debootstrap; run apt-get install debootstrap" >&2; exit 2; }
}

# Makes a Debian with Python's venv only, and keeps it for the next run.
make_system() {
  local suite=$1 root=$systems/$1
  [ -e "$root/complete" ] && return
  say "making a bare Debian $suite in $root"
  rm -rf "$root"
  mkdir -p "$root"
  debootstrap --force-check-gpg --variant=minbase --include=ca-certificates,python3-venv "$suite" "$root" "$mirror" \
    >"$root.log" 2>&1 || { tail -n 5 "$root.log" >&2; exit 2; }
  touch "$root/complete"
}

# Runs a command in a system, with the host's network settings.
inside() {
  local root=$systems/$1
  shift
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  # Includes certificates of a proxy.
  cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/ca-certificates.crt"
  mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
  env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive PIP_CERT=/etc/ssl/certs/ca-certificates.crt \
    SSL_CERT_FILE=/etc/ssl/certs/ca-certificates.crt PIP_DISABLE_PIP_VERSION_CHECK=1 \
    ${CMAKE_BUILD_PARALLEL_LEVEL:+"CMAKE_BUILD_PARALLEL_LEVEL=$CMAKE_BUILD_PARALLEL_LEVEL"} \
    chroot "$root" "$@"
}

# Does the same with ccache: except for the bindings, all Pythons need the same objects.
compiled_once() {
  local system=$1
  shift
  inside "$system" env CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=/ CCACHE_NOHASHDIR=1 "$@"
}

leave_systems() {
  local root
  for root in "$systems"/*/; do
    if mountpoint -q "$root/proc"; then umount "$root/proc"; fi
  done
}
trap leave_systems EXIT
