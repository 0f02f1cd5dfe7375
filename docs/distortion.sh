#!/usr/bin/env bash
# Measures how much patterns are distorted, definition by definition, on the projects that docs/real-data.sh and `make demo`
# leave, at vertical exaggeration 1: the tables of docs/distortion.md. $1 is the folder with the projects of real-data.sh,
# $2 that of the demonstration, $3 a folder for copies and pictures. The second crop of F3 is made here.
set -euo pipefail
data=${PETROGLYPH_DATA:?set PETROGLYPH_DATA to the folder with the real data}
projects=${1:-out/real-data}
demo=${2:-out/demo}
out=${3:-out/distortion}
petroglyph=${PETROGLYPH:-target/debug/petroglyph}
mkdir -p "$out"

west=$out/f3-west.petro
rm -rf "$west"
"$petroglyph" import "$data/volumes/f3_depth_il300-427_xl300-439_int16.sgy" "$west"
"$petroglyph" extract "$west" --fault-evidence 200
for pick in "S1 362,427,1195.164" "S2 362,423,1281.801" "S3 365,368,1478.099" "S4 364,371,1618.803"; do
    read -r name place <<<"$pick"
    "$petroglyph" pick "$west" --at "$place" --horizon "$name" --highest-valid
    "$petroglyph" horizon fill "$west" "$name"
done

# measure NAME PROJECT VIEW...: all definitions on one view.
measure() {
    local name=$1 project=$2
    shift 2
    for definition in distance flow harmonic proportional parallel-to-bottom parallel-to-top; do
        local copy=$out/$name-$definition.petro
        rm -rf "$copy"
        cp -r "$project" "$copy"
        "$petroglyph" layer list "$copy" | sed 's/: .*//' | while read -r layer; do
            "$petroglyph" layer set "$copy" "$layer" --k "$definition" >/dev/null
        done
        echo "== $name, $definition"
        "$petroglyph" render "$copy" "$out/$name-$definition.png" "$@" --ground off --size 700x460 --samples 1 \
            --show distortion --exaggeration 1 --blend 0
        rm -rf "$copy"
    done
}
measure claudius "$projects/claudius.petro" --cut min-min,0.45,0.6 --azimuth 35 --elevation 25
measure penobscot "$projects/penobscot.petro" --azimuth 225 --cut nearest,0.4,0.5
measure penobscot-picks "$projects/picks.petro" --azimuth 225 --cut min-min
measure f3 "$projects/f3.petro" --azimuth 145 --elevation 25 --box 300,427,756,920,1186.8,1826.4 --cut nearest,0.25,0.6
measure f3-west "$west" --azimuth 35 --elevation 25 --cut nearest,0.4,0.5
measure demo "$demo/demo.petro"
