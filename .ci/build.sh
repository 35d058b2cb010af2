#!/bin/sh
# Set-up and Release build into build/release, for demo.sh and test.sh.
#   .ci/build.sh [--target NAME] [-D...]...      -D goes to CMake's configure step; by default everything is built
set -eu
cd "$(dirname "$0")/.."

target=all
if [ $# -ge 2 ] && [ "$1" = --target ]; then
    target=$2
    shift 2
fi

./.ci/setup.sh
if command -v ccache >/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER="${CMAKE_CXX_COMPILER_LAUNCHER-ccache}"
fi
cmake --preset release "$@"
cmake --build --preset release --target "$target"
