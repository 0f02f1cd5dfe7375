#!/usr/bin/env bash
# Draws README's first picture from the project of `petroglyph demo` (`make demo`):
#   docs/readme.sh out/demo/demo.petro [FOLDER]
set -euo pipefail
project=$1
folder=${2:-docs/pictures}
petroglyph=${PETROGLYPH:-target/debug/petroglyph}
"$petroglyph" render "$project" "$folder/demo-illustrative.png" --cut nearest,0.45,0.45 --blend 0 \
    --annotate all --size-cm 17x11.5 --dpi 220 --samples 4 --credit "synthetic survey" \
    --title "A folded and faulted basin below an unconformity" \
    --caption "Block diagram with a corner cut away. The sandstone and marl above the unconformity lie on an eroded \
fold of sandstone, limestone and shale. Half-arrows show which side of each fault went down, and numbers its throw \
on the face on which they stand."
