#!/bin/sh
# Sets up, builds, renders one of the scenes that come with Penumbra and says where the picture is.
#   ./demo.sh [SCENE]       SCENE: a .pbrt file; by default one of scenes/gallery
set -eu
cd "$(dirname "$0")"

if [ $# -gt 1 ] || [ "${1-}" = --help ]; then
    echo "usage: ./demo.sh [SCENE.pbrt]" >&2
    exit 64
fi
scene=${1-scenes/gallery/materials.pbrt}

# Only the program is wanted: the tests would triple the time to the first picture.
./.ci/build.sh --target penumbra

pictures=build/demo
picture=$pictures/$(basename "$scene" .pbrt)
mkdir -p "$pictures"
build/release/penumbra render "$scene" -o "$picture.exr"
build/release/penumbra convert "$picture.exr" "$picture.png"
echo
echo "The picture:            $PWD/$picture.png"
echo "with its error, linear: $PWD/$picture.exr"
