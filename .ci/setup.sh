#!/bin/sh
# Installs what Penumbra is built from, if any of it is missing. For Debian 12, Debian 13 and what derives from them; on
# other systems it says what is needed and leaves the rest to CMake. Plain sh: a minimal system is where it must work.
set -eu

# docs/HACKING.md says what each of these is for.
packages="g++ binutils cmake ninja-build ccache
    libembree-dev libtbb-dev libopenexr-dev libopenimageio-dev libopencolorio-dev libpng-dev zlib1g-dev libssl-dev
    libutf8proc-dev libboost-dev libfmt-dev libcli11-dev nlohmann-json3-dev libgtest-dev libbenchmark-dev"

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "setup: not a Debian system; nothing installed. The build needs the equivalents of:" $packages >&2
    exit 0
fi

missing=""
for package in $packages; do
    if [ "$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null)" != "install ok installed" ]; then
        missing="$missing $package"
    fi
done
[ -n "$missing" ] || exit 0

echo "setup: installing$missing" >&2
as_root=""
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "setup: cannot install without root or sudo; as root, run: apt-get install$missing" >&2
        exit 77
    fi
    as_root="sudo"
fi
# Waits for another package manager's lock rather than fail; asks nothing.
apt_get() {
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 "$@" >&2
}
apt_get update
apt_get install -y --no-install-recommends $missing
