#!/usr/bin/env bash
# Draws the pictures of docs/gallery.md:
#   docs/gallery.sh DEMO FOLDER
# DEMO is the folder of `petroglyph demo`; a second survey with little noise is made beside it for horizons that are
# picked. With PETROGLYPH_DATA, the folder of the data files, F3 is drawn, too. Options for every picture can be given:
# GALLERY_OPTIONS='--size 1600x1200'.
set -euo pipefail
demo=$1
folder=$2
petroglyph=${PETROGLYPH:-target/debug/petroglyph}
mkdir -p "$folder"
draw() {
    local project=$1 name=$2
    shift 2
    # shellcheck disable=SC2086
    "$petroglyph" render "$project" "$folder/$name.png" --size 540x405 --samples 3 --dpi 200 ${GALLERY_OPTIONS:-} "$@" > /dev/null
}

# P-illus 8 and 9: a layer's texture, a volume's textures over it; the same with colour.
illus=$demo/demo.petro
cut="--cut nearest,0.55,0.5 --outlines on"
"$petroglyph" scalar set "$illus" impedance --interval -inf,6.1e6,gravel,1 --interval 6.9e6,inf,dolostone,1
draw "$illus" illus-08-textures-of-a-volume $cut --ground on
"$petroglyph" raw "$illus" --volume impedance --map strata
draw "$illus" illus-09-with-colour $cut --ground on --blend 0.45
"$petroglyph" undo "$illus"
"$petroglyph" undo "$illus"
# P-illus 10: a volume in the cut-out in front of textured back faces.
draw "$illus" illus-10-volume-in-the-cut-out $cut --ground off --medium seismic --clear-below 0.55
# P-illus 11: a layer left standing, high amplitudes in turquoise.
"$petroglyph" layer set "$illus" Limestone --opacity 1
draw "$illus" illus-11-extruding-layer --scene docs/extruding.toml $cut --ground off --exaggeration 1.4
"$petroglyph" undo "$illus"
# P-illus 12: the blend.
for blend in 0 0.5 1; do
    draw "$illus" "illus-12-blend-$blend" $cut --ground on --blend "$blend"
done

# P-horiz: two horizons picked from an extraction.
picked=$demo/picked.petro
rm -rf "$picked" "$demo/clear"
"$petroglyph" synth "$demo/clear" --size 144x144x112 --seed 7 --snr 20
"$petroglyph" import "$demo/clear/survey.sgy" "$picked"
"$petroglyph" extract "$picked"
volume="--technique occlusion"
# P-horiz 4: leaves over the data, and the distance to the nearest.
draw "$picked" horiz-04-leaves --blend 1 --show leaves --box 110,244,510,644,180,1110 --cut nearest,0.5,0.5
draw "$picked" horiz-04-distance --blend 1 --show distance --box 110,244,510,644,180,1110 --cut nearest,0.5,0.5
# P-horiz 5: gradients, none, and both in stripes.
for technique in phong occlusion interleaved; do
    draw "$picked" "horiz-05-$technique" --technique "$technique" --clear-below 0.2
done
# P-horiz 6: a pick climbs its tree to the whole surface.
"$petroglyph" pick "$picked" --at 190,566,528.6 --horizon A --colour '#e85a9b'
low="--box 150,244,510,644,420,1110 --azimuth 320 --elevation 40"
draw "$picked" horiz-06-a-leaf $volume $low --clear-below 0.8 --horizon A
"$petroglyph" climb "$picked" 1 --levels 3
draw "$picked" horiz-06-b-three-levels-up $volume $low --clear-below 0.8 --horizon A
"$petroglyph" climb "$picked" 1 --highest-valid
draw "$picked" horiz-06-c-highest-valid $volume $low --clear-below 0.8 --horizon A
# P-horiz 3: the leaves of that surface, and their nodes three levels up.
draw "$picked" horiz-03-leaves $volume $low --scope near --clear-below 0.98 --horizon A --level 0
draw "$picked" horiz-03-three-levels-up $volume $low --scope near --clear-below 0.98 --horizon A --level 3
"$petroglyph" horizon remove "$picked" A
# P-horiz 7: two horizons.
for place in 115,583,260.1 145,569,338.4 221,575,195.9; do
    "$petroglyph" pick "$picked" --at $place --horizon Top --colour '#e85a9b' --highest-valid || true
done
for place in 120,577,558.2 153,567,778 189,569,513 229,573,456; do
    "$petroglyph" pick "$picked" --at $place --horizon Base --colour '#f2c12e' --highest-valid || true
done
both="--box 101,244,501,644,240,1110 --clear-below 0.45 --azimuth 35 --elevation 35"
draw "$picked" horiz-07-semi-transparent $volume $both --horizon 'Top,#e85a9b,0.2' --horizon Base
draw "$picked" horiz-07-top-glows $volume $both --horizon 'Top,#e85a9b,1,0.3' --horizon Base
draw "$picked" horiz-07-bottom-glows $volume $both --horizon 'Top,#e85a9b,0.5' --horizon 'Base,#f2c12e,1,0.3'
draw "$picked" horiz-07-both-glow $volume $both --horizon 'Top,#e85a9b,1,0.3' --horizon 'Base,#f2c12e,1,0.3'
"$petroglyph" raw "$picked" --map grey
cube="--technique illustrate --blend 1 --ground off --outlines on --exaggeration 1.6 --azimuth 35 --elevation 35"
draw "$picked" horiz-07-extruding-from-a-cube $cube --cut nearest,0.7,0.6 --horizon Top --horizon Base
printf 'md,inclination,azimuth\n0,0,0\n300,0,0\n1150,35,60\n' > "$demo/A-1.csv"
"$petroglyph" well add "$picked" "$demo/A-1.csv" --name A-1 --head 430700,6780900 --kb 0
draw "$picked" horiz-07-with-a-well $cube --cut nearest,0.8,0.75 --horizon 'Top,#e85a9b,0.3' --horizon Base

# F3.
if [ -n "${PETROGLYPH_DATA:-}" ]; then
    f3=$demo/f3.petro
    rm -rf "$f3"
    "$petroglyph" import "$PETROGLYPH_DATA/volumes/f3_depth_il300-427_xl720-975_int16.sgy" "$f3"
    "$petroglyph" extract "$f3"
    place="--box 300,427,720,975,1202.4,1826.4 --exaggeration 3"
    draw "$f3" f3-occlusion $volume $place --clear-below 0.15
    draw "$f3" f3-leaves $place --cut nearest,0.5,0.4 --blend 1 --level 3
fi

# The start page's block, illustrated and raw: pixels for displays of twice the usual density, nothing behind it.
start=${START:-}
if [ -n "$start" ]; then
    for side in illustrated,0 raw,1; do
        "$petroglyph" render "$illus" "$start/${side%,*}.png" --cut nearest,0.5,0.55 --ground on --outlines on --size 1100x500 \
            --background transparent --samples 4 --azimuth 22 --elevation 27 --exaggeration 1.5 --zoom 1.14 --blend "${side#*,}" > /dev/null
    done
fi
