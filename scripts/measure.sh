#!/usr/bin/env bash
# Times both voxelizers at 64, 128 and 256 voxels for the presets, one JSON file each (schema: docs/stats.md).
# usage: scripts/measure.sh SCENE FOLDER [conelab options, for example --set shadow_dim=2048]
set -euo pipefail
scene=$1 folder=$2
shift 2
conelab=${CONELAB:-target/release/conelab}
frames=${FRAMES:-100} warmup=${WARMUP:-20} size=${SIZE:-1920x1080}
mkdir -p "$folder"
for preset in ${PRESETS:-thesis default}; do
    for voxelizer in raster tessellated; do
        for dim in ${DIMS:-64 128 256}; do
            name=$preset-$voxelizer-$dim
            "$conelab" render "configs/$preset.ron" --scene "$scene" --size "$size" --frames "$frames" \
                --warmup "$warmup" --set "voxelizer=$voxelizer" --set "voxel_dim=$dim" "$@" \
                --json "$folder/$name.json" -o "$folder/$name.png" 2>&1 | sed "s/^/$name: /"
        done
    done
done
