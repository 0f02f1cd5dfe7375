#!/usr/bin/env bash
# Draws the pictures of docs/ and files of every kind with two builds of the program, and compares them byte for byte:
#   bench/pictures.sh OLD NEW [FOLDER]
# OLD and NEW are programs (target/debug/petroglyph). Everything lies in FOLDER/old and FOLDER/new afterwards (out/compared
# if none is named). With PETROGLYPH_DATA, the folder of the data files, real data are drawn, too, in tens of minutes.
# Prints every file that differs or that one program did not write; the exit code is 1 if there is one.
set -euo pipefail
old=$(realpath "$1")
new=$(realpath "$2")
mkdir -p "${3:-out/compared}"
folder=$(realpath "${3:-out/compared}")
export XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-/tmp}

# One after another, and in a folder of one name for both: a page may say where its project lies.
draw() {
    export PETROGLYPH=$1
    local out=$folder/drawn
    rm -rf "$out" "$2"
    mkdir -p "$out/pictures" "$out/gallery" "$out/files" "$out/state"
    export XDG_STATE_HOME=$out/state
    "$PETROGLYPH" demo --out "$out/demo"
    cp "$out"/demo/*.png "$out/files"
    files "$out/demo/demo.petro" "$out/files"
    docs/readme.sh "$out/demo/demo.petro" "$out/pictures"
    docs/gallery.sh "$out/demo" "$out/gallery"
    [ -z "${PETROGLYPH_DATA:-}" ] || docs/real-data.sh "$out/projects" "$out/pictures"
    "$PETROGLYPH" patterns "$out/pictures/patterns.png"
    mkdir -p "$2"
    mv "$out/pictures" "$out/gallery" "$out/files" "$2"
    rm -rf "$out"
}

# One file of each kind that the program writes from a project.
files() {
    local project=$1 files=$2 ending
    for ending in png tif svg pdf; do
        "$PETROGLYPH" render "$project" "$files/block.$ending" --cut nearest,0.45,0.45 --size 480x360
        "$PETROGLYPH" render "$project" "$files/page.$ending" --cut nearest,0.45,0.45 --annotate all --size-cm 12x9 --dpi 100
        "$PETROGLYPH" render "$project" "$files/sections.$ending" --inline 130 --crossline 560 --slice 500 --interpretation --size 480x360
        "$PETROGLYPH" render "$project" "$files/map.$ending" --map Bravo --annotate all --size 480x360
    done
    for technique in occlusion phong; do
        "$PETROGLYPH" render "$project" "$files/$technique.png" --technique "$technique" --clear-below 0.3 --size 320x240
    done
    "$PETROGLYPH" render "$project" "$files/black-and-white.svg" --preset black-and-white --annotate all --size-cm 12x9
    "$PETROGLYPH" animate "$project" "$files/turn.gif" --frames 3 --size 160x120
    "$PETROGLYPH" animate "$project" "$files/turn.png" --frames 3 --size 160x120
    "$PETROGLYPH" review "$project" "$files/review.html" --density 200
    "$PETROGLYPH" export "$project" "$files/model.glb" --model --density 200
    "$PETROGLYPH" export "$project" "$files/horizon.dat" --horizon Bravo --format opendtect
    "$PETROGLYPH" export "$project" "$files/fault.ts" --fault "Normal fault" --format tsurf
    "$PETROGLYPH" info "$project" --json > "$files/info.json"
}

draw "$old" "$folder/old" > "$folder/old.log"
draw "$new" "$folder/new" > "$folder/new.log"
differ=0
while read -r file; do
    cmp -s "$folder/old/$file" "$folder/new/$file" || { echo "differs: $file"; differ=1; }
done < <(cd "$folder" && find old new -type f -printf '%P\n' | sort -u)
[ "$differ" = 1 ] || echo "the same bytes: $(find "$folder/new" -type f | wc -l) files"
exit "$differ"
