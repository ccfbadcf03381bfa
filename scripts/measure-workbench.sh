#!/usr/bin/env bash
# What the workbench itself costs: its interface per frame, and the time from saving a shader to its picture.
#
#   scripts/measure-workbench.sh [SCENE] [SIZE] [conelab]
#
# Needs no window system. Prints milliseconds: least, median, 95th percentile.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scene=${1:-atrium}
size=${2:-1280x720}
conelab=$(realpath "${3:-target/release/conelab}")

home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT
cp -r passes shaders configs "$home/"
export CONELAB_HOME=$home
for tab in Scene Profiler; do
    echo "tab $tab, two voxelizers, rendering on"
    "$conelab" screenshot --scene "$scene" --size "$size" --click Compare --click "raster | tessellated" --click "$tab" \
        --click continuous \
        --measure 300 -o "$home/shot.png"
done
echo "pictures painted as they come, and sixty times a second"
for every in "" "--every 16.667"; do
    # shellcheck disable=SC2086 # an option and its value, or nothing
    "$conelab" screenshot --scene "$scene" --size "$size" --click continuous --pace 300 $every -o "$home/shot.png"
done
echo "an edit of the shader of the default's rays"
"$conelab" screenshot --scene "$scene" --size "$size" -o "$home/shot.png" --times 25 \
    --edit "$home/shaders/surfels/rays.glsl" --from '0.5698402910' --to '0.5698402911'
