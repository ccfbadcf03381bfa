#!/usr/bin/env bash
# Measures again what docs/results.md has tables of, on this machine's device, and puts the figures into docs/recorded.
# Then `CONELAB_BLESS=1 cargo test --release --test results` writes the tables.
#
#   scripts/record.sh [NAME...]      all that is below when none is named
#
# CONELAB: the program (target/release/conelab). COMMIT: what it was built from (git's HEAD). OUT: where the figures go.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
conelab=${CONELAB:-target/release/conelab}
commit=${COMMIT:-$(git rev-parse --short HEAD)}
out=${OUT:-docs/recorded}
sponza=configs/scenes/sponza.ron
work=captures/recorded
mkdir -p "$out" "$work"

# The arguments as one would type them.
typed() {
    local word
    for word; do
        if [[ $word =~ ^[A-Za-z0-9_./,=:-]+$ ]]; then printf ' %s' "$word"; else printf " '%s'" "$word"; fi
    done
}

# keep NAME JSON CSV COMMAND...: the figures in the file CSV, under the command and the device that is named in the file JSON.
keep() {
    local name=$1 json=$2 csv=$3 device driver
    shift 3
    device=$(grep -m1 -o '"name": *"[^"]*"' "$json" | cut -d'"' -f4)
    driver=$(grep -m1 -o '"driver": *"[^"]*"' "$json" | cut -d'"' -f4)
    { printf '# conelab%s\n# %s, %s\n# %s\n' "$(typed "$@")" "$device" "$driver" "$commit" && cat "$csv"; } >"$out/$name.csv"
}

# keep_json NAME JSON COMMAND...: the same of figures that are JSON, with their device in them.
keep_json() {
    local name=$1 json=$2
    shift 2
    { printf '{"command": "conelab%s", "commit": "%s", "record":\n' "$(typed "$@")" "$commit" && cat "$json" && echo '}'; } >"$out/$name.json"
}

# What the program is asked for, as one would type it.
run() {
    printf '%s: conelab %s\n' "$name" "$*" >&2
    "$conelab" "$@" >/dev/null
}

bench() {
    run bench "$@" -o "$work/$name"
    keep "$name" "$work/$name/bench.json" "$work/$name/bench.csv" bench "$@"
}

sweep() {
    run sweep "$@" -o "$work/$name"
    keep "$name" "$(find "$work/$name/points" -name '*.json' | sort | head -n 1)" "$work/$name/sweep.csv" sweep "$@"
}

record() {
    local name=$1 threads=(configs/rays.ron configs/raster.ron)
    case $name in
        thesis) bench configs/thesis.ron --scene "$sponza" --sizes 1920x1080 --axis voxel_dim=64,128,256 \
            --axis voxelizer=raster,tessellated --rounds 3 --frames 20 ;;
        rays) bench "${threads[@]}" --scene "$sponza" --sizes 1920x1080 --axis voxel_dim=160,256 --rounds 3 ;;
        pixels) bench configs/rays.ron --scene "$sponza" --sizes 1920x1080,3840x2160 --set voxel_dim=256 --rounds 3 ;;
        cells) bench configs/rays.ron --scene "$sponza" --sizes 1920x1080 --axis voxel_dim=256,512 \
            --set voxel_capacity=1750000 --set fragment_capacity=2850000 --rounds 3 ;;
        rooms) bench configs/rays.ron --sizes 1920x1080 \
            --axis "scene=\"cornell\",\"atrium\",\"$sponza\",\"configs/scenes/living-room.ron\",\"street\",\"emitters\",\"foliage\"" --rounds 3 ;;
        lights) bench configs/rays.ron --sizes 1920x1080 \
            --axis 'scene="atrium","configs/scenes/lamps-3.ron","configs/scenes/lamps-32.ron"' --rounds 3 ;;
        actors)
            local way=(render configs/rays.ron --scene atrium --size 1920x1080 --execution incremental
                --step 0.0166667 --warmup 200 --frames 300)
            run "${way[@]}" --json "$work/actors.json" -o "$work/actors.png"
            keep_json actors "$work/actors.json" "${way[@]}"
            ;;
        moving)
            local way=(render configs/rays.ron --scene "$sponza" --size 1920x1080 --set voxel_dim=256 --execution incremental
                --path configs/paths/sponza.ron --step 0.0166667 --warmup 600 --frames 300)
            run "${way[@]}" --json "$work/moving.json" -o "$work/moving.png"
            keep_json moving "$work/moving.json" "${way[@]}"
            ;;
        scenes) sweep configs/sweeps/scenes.ron --reference 1024 ;;
        families) # the charts, the fronts, and pictures of two scenes too
            sweep configs/sweeps/families.ron --reference 1024
            run report "$work/families" --metric flip
            keep fronts "$(find "$work/families/points" -name '*.json' | sort | head -n 1)" \
                "$work/families/report/fronts.csv" report "$work/families" --metric flip
            mkdir -p docs/families
            local chart scene method id
            for chart in "$work"/families/report/total-flip-*.svg; do
                scene=$(grep -m1 -oE '(corridor|door-ajar|foliage|sky-window|sponza) at [0-9]+x' "$chart" | cut -d' ' -f1) || continue
                cp "$chart" "docs/families/$scene.svg"
            done
            sed -nE 's/^([0-9a-f]+),done,[^,]*(corridor|sponza)[^,]*,(rays|cones|thesis|ddgi|ssgi|ssgi and rays|rsm|lpv),.*/\1 \2 \3/p' \
                "$work/families/sweep.csv" | while read -r id scene method; do
                cp "$work/families/pictures/$id.jpg" "docs/families/$scene-${method// /-}.jpg"
            done
            ;;
        steadiness)
            run stability configs/stability/families.ron --spp 128 -o "$work/steadiness"
            keep steadiness "$work/steadiness/stability.json" "$work/steadiness/stability.csv" \
                stability configs/stability/families.ron --spp 128
            ;;
        methods) bench configs/rays.ron configs/cones.ron configs/thesis.ron configs/ddgi.ron configs/ssgi.ron \
            configs/ssgi_rays.ron configs/rsm.ron configs/lpv.ron --sizes 1920x1080 \
            --axis "scene=\"cornell\",\"atrium\",\"$sponza\"" --rounds 2 --frames 20 ;;
        exposures) sweep configs/sweeps/thesis.ron --reference 1024 ;;
        lamps) sweep configs/sweeps/lamps.ron --reference 512 ;;
        sponza) # the chart alone
            run sweep configs/sweeps/sponza.ron --reference 4096 -o "$work/sponza"
            run report "$work/sponza"
            cp "$work"/sponza/report/total-relmse*.svg docs/sponza.svg
            ;;
        voxels)
            local ways=(voxels configs/rays.ron --scene "$sponza" --set voxel_dim=128 --all)
            run "${ways[@]}" --json "$work/voxels.json"
            keep_json voxels "$work/voxels.json" "${ways[@]}"
            ;;
        *) printf 'no record "%s"\n' "$name" >&2 && return 1 ;;
    esac
}

[[ $# -gt 0 ]] || set -- thesis rays pixels cells rooms lights moving actors scenes families steadiness methods exposures lamps sponza voxels
for name; do record "$name"; done
