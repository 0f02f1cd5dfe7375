#!/usr/bin/env bash
# Draws README's first picture, a section of the same rock, a page of four, a map, the throw along a fault, and the block in black and white, from the project of
# `petroglyph demo` (`make demo`), and the blocks with salt and with an overturned limb from synthetic surveys, one of them without an interpretation, that it makes in a temporary folder:
#   docs/readme.sh out/demo/demo.petro [FOLDER]
set -euo pipefail
project=$1
folder=${2:-docs/pictures}
petroglyph=${PETROGLYPH:-target/debug/petroglyph}
"$petroglyph" render "$project" "$folder/demo-illustrative.png" --cut nearest,0.45,0.45 --blend 0 \
    --annotate all --size-cm 17x13 --dpi 220 --samples 4 --credit "synthetic survey" \
    --title "A folded and faulted basin below an unconformity" \
    --caption "Block diagram with a corner cut away. The sandstone and marl above the unconformity lie on an eroded \
fold of sandstone, limestone and shale. Half-arrows show which side of each fault went down, and numbers its throw \
on the face on which they stand; where a contact is in short dashes and queried it was continued beyond the data."
"$petroglyph" render "$project" "$folder/section-rock.png" --crossline 560 --section-blend 0 --annotate all \
    --size-cm 17x9 --dpi 150 --credit "synthetic survey"
"$petroglyph" render "$project" "$folder/figure-four.png" --block --inline 130 --crossline 560 --slice 500 \
    --cut nearest,0.45,0.45 --blend 0 --size-cm 17x12 --dpi 150
"$petroglyph" render "$project" "$folder/figure-map.png" --map Bravo --annotate all --size-cm 14x12 --dpi 150 \
    --credit "synthetic survey"
"$petroglyph" render "$project" "$folder/throw-profile.png" --throw "Dying fault" --heave --size-cm 15x13 --dpi 150

"$petroglyph" render "$project" "$folder/cut-fence.png" --size 1080x720 --samples 4 --azimuth 335 --zoom 1.05 \
    --cut-fence 101,545 150,585 205,560 260,600 --cut-smooth
"$petroglyph" render "$project" "$folder/cut-shaft.png" --size 1080x720 --samples 4 --zoom 1.05 \
    --cut-round 170,560,900 --cut-depth 0,900
"$petroglyph" render "$project" "$folder/demo-black-and-white.png" --cut nearest,0.45,0.45 --blend 0 \
    --annotate all --size-cm 17x11.5 --dpi 150 --samples 4 --preset black-and-white

made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
quietly() { "$petroglyph" "$@" > /dev/null 2>&1; }

# Three wells with tops and one without, whose layers are the model's.
cp -r "$project" "$made/wells.petro"
printf 'md_m,inc,azi\n0,0,0\n1240,0,0\n' > "$made/path.csv"
printf '%s\n' surface,md_m,well Alpha,283,A-1 Bravo,409,A-1 Unconformity,525,A-1 Charlie,870,A-1 Delta,1125,A-1 \
    Alpha,395,A-2 Bravo,520,A-2 Unconformity,643,A-2 Charlie,868,A-2 Delta,1088,A-2 \
    Alpha,308,B-1 Bravo,456,B-1 Unconformity,603,B-1 Charlie,636,B-1 Delta,852,B-1 > "$made/tops.csv"
well() { quietly well add "$made/wells.petro" "$made/path.csv" --name "$1" --head "$2" --kb 25 "${@:3}"; }
well A-1 430500,6780700 --tops "$made/tops.csv"
well A-2 431500,6781800 --tops "$made/tops.csv"
well B-1 432600,6780900 --tops "$made/tops.csv"
well B-2 433500,6782600
"$petroglyph" render "$made/wells.petro" "$folder/demo-correlation.png" --correlation --datum Unconformity \
    --size-cm 17x11 --dpi 150 --legend --scale-bar
"$petroglyph" render "$project" "$folder/demo-water.png" --cut nearest,0.45,0.45 --blend 0 --water 330 \
    --annotate all --size-cm 17x11.5 --dpi 150 --samples 4

"$petroglyph" synth "$made/salt" --salt --size 112x112x96 > /dev/null 2>&1
quietly import "$made/salt/survey.sgy" "$made/salt.petro"
for fault in "$made"/salt/faults/*.ts; do
    quietly fault add "$made/salt.petro" "$fault" --name "$(basename "$fault" .ts)"
done
for horizon in Alpha Bravo Unconformity Charlie Delta; do
    contact=conformable
    if [ "$horizon" = Unconformity ]; then contact=erosional; fi
    quietly horizon add "$made/salt.petro" "$made/salt/horizons/$horizon.csv" --name "$horizon" --contact "$contact"
done
quietly horizon add "$made/salt.petro" "$made/salt/horizons/Salt.ts" --name Salt
"$petroglyph" render "$made/salt.petro" "$folder/salt.png" --size-cm 17x12 --dpi 200 --samples 4

"$petroglyph" synth "$made/outcrop" --overturned --size 112x90x80 > "$made/told"
# The last line that it prints is the command that makes the project.
eval "quietly create $made/outcrop.petro $(tail -1 "$made/told" | cut -d' ' -f4-)"
for fault in "$made"/outcrop/faults/*.ts; do
    quietly fault add "$made/outcrop.petro" "$fault" --name "$(basename "$fault" .ts)"
done
for horizon in "$made"/outcrop/horizons/*.csv; do
    quietly horizon add "$made/outcrop.petro" "$horizon" --name "$(basename "$horizon" .csv)"
done
"$petroglyph" render "$made/outcrop.petro" "$folder/overturned.png" --size-cm 17x12 --dpi 200 --samples 4

# Faults and layers without an interpretation.
"$petroglyph" synth "$made/found" --size 128x128x128 --seed 1 > "$made/told"
quietly illustrate "$made/found/survey.sgy" "$folder/illustrate-synthetic.png" --project "$made/illustrate-synthetic.petro"
