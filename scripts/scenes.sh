#!/usr/bin/env bash
# Compares the scenes in the folders of CONELAB_SCENES with those that the published figures use. Exit 1: a file is
# missing or different.
#
#   CONELAB_SCENES=/path/to/scenes scripts/scenes.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

IFS=: read -ra folders <<<"${CONELAB_SCENES:-configs/scenes}"
bad=0
while read -r sum file; do
    found=
    for folder in "${folders[@]}"; do
        [[ ! -f $folder/$file ]] || { found=$folder/$file && break; }
    done
    if [[ -z $found ]]; then
        printf 'missing    %s\n' "$file"
    elif [[ $(sha256sum <"$found") == "$sum "* ]]; then
        printf 'same       %s\n' "$found"
        continue
    else
        printf 'different  %s\n' "$found"
    fi
    bad=1
done <configs/scenes/checksums.txt
exit $bad
