#!/usr/bin/env bash
# Draws the pictures of docs/real-data.md. PETROGLYPH_DATA is the folder with the data files, $1 the folder for projects, $2 that for pictures.
set -euo pipefail
data=${PETROGLYPH_DATA:?set PETROGLYPH_DATA to the folder with the real data}
out=${1:-out/real-data}
pictures=${2:-docs/pictures}
petroglyph=${PETROGLYPH:-target/debug/petroglyph}
mkdir -p "$out" "$pictures"
rm -rf "$out"/claudius.petro "$out"/penobscot.petro "$out"/f3.petro

# Claudius: four horizons with gaps and a fault, no seismic. The points hold Z = -3 x TWT in ms, the fault says "Elevation" itself.
claudius=$data/interpretation/claudius
project=$out/claudius.petro
"$petroglyph" create "$project" --bounds 548876.81,552451.81,7816647.43,7821846.72,2760,3640 --size 144x140x177 --z-unit ms
"$petroglyph" velocity "$project" 2500
"$petroglyph" fault add "$project" "$claudius/Fault.ts" --name "Small fault" --z-unit ms --z-factor 0.333333
for name in A B C D; do
    "$petroglyph" horizon add "$project" "$claudius/${name}Points.csv" --name $name --z-unit ms --z-factor -0.333333
done
"$petroglyph" layer set "$project" "above A" --name "Upper shale" --pattern shale
"$petroglyph" layer set "$project" "A - B" --name "Marl" --pattern marl
"$petroglyph" layer set "$project" "B - C" --name "Sandstone" --pattern sandstone-bedded
"$petroglyph" layer set "$project" "C - D" --name "Lower shale" --pattern shale-sandy
"$petroglyph" layer set "$project" "below D" --name "Basement" --pattern granite
"$petroglyph" render "$project" "$pictures/claudius-block.png" --cut min-min,0.45,0.6 --exaggeration 2 --azimuth 35 --elevation 25 --ground off --size 1600x1100

# Penobscot: the volume with Horizon B, two open layers, blended to the raw data.
project=$out/penobscot.petro
"$petroglyph" import "$data/volumes/penobscot_il1207-1456_xl1253-1402_t876-1032_int16.sgy" "$project"
"$petroglyph" horizon add "$project" "$data/interpretation/penobscot_horizon_B/opendtect_xy_ilxl.dat" --name "Horizon B" --z-unit ms
"$petroglyph" layer set "$project" "above Horizon B" --pattern shale
"$petroglyph" layer set "$project" "below Horizon B" --pattern sandstone-bedded
"$petroglyph" raw "$project" --volume seismic --map grey
for blend in 0 0.5 1; do
    "$petroglyph" render "$project" "$pictures/penobscot-blend-$blend.png" --blend $blend --exaggeration 5 --azimuth 225 --ground off --cut nearest,0.4,0.5 --size 1400x900
done

# F3: the salt dome, raw.
project=$out/f3.petro
"$petroglyph" import "$data/volumes/f3_depth_il300-427_xl720-975_int16.sgy" "$project"
"$petroglyph" raw "$project" --volume seismic --map grey
"$petroglyph" render "$project" "$pictures/f3-raw.png" --blend 1 --exaggeration 3 --box 300,427,720,975,1202.4,1826.4 --cut nearest,0.5,0.4 --size 1400x950
