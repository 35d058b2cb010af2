#!/bin/sh
# Renders every picture of the documentation out of scenes/gallery: some minutes on two processors.
#   docs/pictures/make.sh [PROGRAM]      PROGRAM: build/release/penumbra by default
set -eu
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "${1-$here/../../build/release/penumbra}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$here/../../scenes/gallery"

# picture NAME SCENE OPTION...: renders the scene and shows it as NAME.jpg
picture() {
    name=$1 scene=$2
    shift 2
    "$program" render "$scene.pbrt" --strict -o "$scratch/$name.exr" --progress none "$@"
    "$program" convert "$scratch/$name.exr" "$here/$name.jpg" --quality 90 --quiet
}

picture materials materials --spp 256
for scene in absorption coats cornell cutouts dof environment hair highlights lens mappings measured mixes motion multiscatter panorama procedural relief rough_glass spectra textures lights lamps portal screens; do
    picture $scene $scene --spp 256
done
picture shapes shapes --spp 256
picture instances instances --spp 128
picture orthographic orthographic
picture furnace furnace
for strategy in mis bsdf light; do picture veach_$strategy veach_mis --spp 16 --strategy $strategy; done
for filter in box triangle gaussian mitchell sinc; do picture filter_$filter filter_$filter; done

# The error that a picture carries.
picture cornell_noisy cornell --spp 16
"$program" convert "$scratch/cornell_noisy.exr" "$here/cornell_error.jpg" --layer SE --quality 90 --quiet
