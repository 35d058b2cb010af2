#!/bin/sh
# Set-up and Release build, for demo.sh and test.sh. Arguments go to CMake's configure step. Ends in build/release.
set -eu
cd "$(dirname "$0")/.."

./.ci/setup.sh
if command -v ccache >/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER="${CMAKE_CXX_COMPILER_LAUNCHER-ccache}"
fi
cmake --preset release "$@"
cmake --build --preset release
