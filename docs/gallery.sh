#!/bin/sh
# Draws the pictures of docs/gallery.md from a project with volumes `seismic` and `impedance` and horizons Alpha, Bravo, Gamma (the demonstration's):
#   docs/gallery.sh PETROGLYPH PROJECT FOLDER
# Each picture takes seconds on two cores. Extra options go to every picture: GALLERY_OPTIONS='--size 800x600 --samples 1'.
set -eu
petroglyph=$1
project=$2
folder=$3
mkdir -p "$folder"
draw() {
    name=$1
    shift
    # shellcheck disable=SC2086
    "$petroglyph" render "$project" "$folder/$name.png" --size 900x675 --samples 2 --dpi 200 ${GALLERY_OPTIONS:-} "$@"
}
cut="--cut nearest,0.55,0.5 --outlines on"

# P-illus 8, 9 and 12: scalar textures and the blend.
for blend in 0 0.35 0.65 1; do
    draw "blend-$blend" $cut --ground on --blend "$blend"
done
# P-illus 10 and 11: a volume in the cut-out, whole and in a layer that was left standing.
draw cut-out-volume $cut --ground off --medium seismic --clear-below 0.2
"$petroglyph" layer set "$project" Limestone --opacity 1
draw cut-out-layer $cut --ground off --medium seismic --clear-below 0
"$petroglyph" undo "$project"
# P-horiz 5: gradients, and none.
draw phong --technique phong --clear-below 0.25
draw occlusion --technique occlusion --clear-below 0.25
draw unshaded --technique volume --clear-below 0.25
# P-horiz 4: distances on faces; 6 and 7: horizons in the volume.
draw distance $cut --ground off --show distance
draw leaves $cut --ground off --show leaves --blend 1
draw horizons --technique occlusion --clear-below 0.35 --horizon Alpha --horizon Bravo
draw horizon-semi-transparent --technique occlusion --clear-below 0.35 --horizon Alpha,#e85a9b,0.25 --horizon Bravo
draw horizon-top-glowing --technique occlusion --clear-below 0.35 --horizon Alpha,#e85a9b,1,1 --horizon Bravo
draw horizon-bottom-glowing --technique occlusion --clear-below 0.35 --horizon Alpha,#e85a9b,0.5 --horizon Bravo,#f2c12e,1,1.2
draw horizons-both-glowing --technique occlusion --clear-below 0.35 --horizon Alpha,#e85a9b,1,1 --horizon Bravo,#f2c12e,1,1
draw horizons-near --technique occlusion --scope near --clear-below 0.1 --horizon Alpha --horizon Bravo
draw horizons-away --technique occlusion --scope away --clear-below 0.35 --horizon Alpha,#e85a9b,0.02
