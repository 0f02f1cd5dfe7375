#!/usr/bin/env bash
# Draws the pictures of docs/real-data.md. PETROGLYPH_DATA is the folder with the data files, $1 the folder for projects,
# $2 the folder for pictures.
set -euo pipefail
data=${PETROGLYPH_DATA:?set PETROGLYPH_DATA to the folder with the real data}
out=${1:-out/real-data}
pictures=${2:-docs/pictures}
petroglyph=${PETROGLYPH:-target/debug/petroglyph}
mkdir -p "$out" "$pictures"
rm -rf "$out"/claudius.petro "$out"/penobscot.petro "$out"/f3.petro

# Claudius: four horizons with gaps and a fault, no seismic. The points hold Z = -3 x TWT in ms, the fault
# states "Elevation" itself.
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
for ending in png svg pdf; do
    "$petroglyph" render "$project" "$pictures/claudius-block.$ending" --cut min-min,0.45,0.6 --exaggeration 2 --azimuth 35 --elevation 25 --ground off --size 1600x1100
done

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

# F3: from the raw volume to the block. The samples are clipped and the salt is chaotic, so faults need more evidence than usual.
project=$out/f3.petro
"$petroglyph" import "$data/volumes/f3_depth_il300-427_xl720-975_int16.sgy" "$project"
"$petroglyph" raw "$project" --volume seismic --map grey
"$petroglyph" extract "$project" --fault-evidence 200
"$petroglyph" fault pick "$project" --name "Graben, south-east wall" --stick 380,866,1480 380,856,1640 380,847,1790 \
    --stick 385,861,1480 385,850,1640 385,840,1790 --stick 395,843,1500 395,833,1670 395,826,1790 \
    --stick 405,834,1530 405,825,1670 405,815,1824
"$petroglyph" fault pick "$project" --name "Graben, north-west wall" --stick 385,831,1530 385,838,1650 385,843,1735 \
    --stick 395,815,1530 395,822,1670 395,827,1765 --stick 405,801,1540 405,808,1670 405,815,1805
"$petroglyph" fault truncate "$project" "Graben, north-west wall" --by "Graben, south-east wall"
"$petroglyph" fault pick "$project" --name "Crest, east wall" --stick 336,884,1470 336,877,1610 \
    --stick 345,881,1480 345,875,1620 --stick 352,879,1480 352,873,1620 --stick 358,879,1490 358,873,1620
"$petroglyph" fault pick "$project" --name "Crest, west wall" --stick 326,847,1470 326,852,1600 \
    --stick 340,852,1480 340,858,1610 --stick 352,853,1480 352,859,1620 --stick 358,855,1490 358,861,1620
pick() { "$petroglyph" pick "$project" --at "$2" --horizon "$1" "${@:3}"; }
pick "Overburden 1" 364,860,1236 --highest-valid
pick "Overburden 2" 375,849,1304 --highest-valid
pick "Top Chalk" 355,849,1488.7 --up 5
for place in 399,876,1531.2 317,734,1806.3 411,796,1567.3 395,827,1599 421,835,1557 424,823,1573 331,876,1510 314,832,1603; do
    pick "Top Chalk" $place --highest-valid
done
for name in "Overburden 1" "Overburden 2" "Top Chalk"; do
    "$petroglyph" horizon fill "$project" "$name"
done
"$petroglyph" layer set "$project" "above Overburden 1" --name "Upper overburden" --pattern siltstone
"$petroglyph" layer set "$project" "Overburden 1 - Overburden 2" --name "Middle overburden" --pattern sandstone-bedded
"$petroglyph" layer set "$project" "Overburden 2 - Top Chalk" --name "Lower overburden" --pattern shale
"$petroglyph" layer set "$project" "below Top Chalk" --name "Chalk and older" --pattern chalk
for blend in 0 0.5 1; do
    "$petroglyph" render "$project" "$pictures/f3-blend-$blend.png" --blend $blend --exaggeration 2.5 --azimuth 145 --elevation 25 --ground off \
        --box 300,427,756,920,1186.8,1826.4 --cut nearest,0.25,0.6 --size 1400x930
done

# Penobscot: Horizon B by picks, between four faults that were drawn where sections show them.
project=$out/picks.petro
rm -rf "$project"
"$petroglyph" import "$data/volumes/penobscot_il1207-1456_xl1253-1402_t876-1032_int16.sgy" "$project"
"$petroglyph" raw "$project" --volume seismic --map grey
"$petroglyph" extract "$project" --fault-evidence 100
"$petroglyph" fault pick "$project" --name "South-west fault" --stick 1307,1258,912 1300,1258,1000 --stick 1297,1268,920 1288,1268,1000 \
    --stick 1284,1280,928 1277,1280,1000 --stick 1277,1291,956 1271,1291,1008
"$petroglyph" fault pick "$project" --name "West fault" --stick 1292,1305,932 1286,1305,980 \
    --stick 1267,1323,951 1262,1323,984 --stick 1258,1335,960 1253,1335,996
"$petroglyph" fault pick "$project" --name "North-west fault" --stick 1268,1375,984 1264,1375,1020 --stick 1272,1393,988 1268,1393,1020
"$petroglyph" fault pick "$project" --name "North-east fault" --stick 1435,1343,972 1429,1343,1020 --stick 1433,1360,960 1430,1360,1000 \
    --stick 1435,1374,956 1431,1374,1008 --stick 1435,1388,944 1429,1388,1024 --stick 1433,1400,956 1429,1400,1012
# The faults are drawn around the horizon, and taken to go on through the thin volume and to its border.
for fault in South-west West North-west North-east; do
    "$petroglyph" fault extent "$project" "$fault fault" grow 250
done
for place in 1349,1330,954.7 1229,1336,962.8 1249,1265,977.7; do
    "$petroglyph" pick "$project" --at $place --horizon B --highest-valid
done
for place in 1443,1312,946.7 1438,1286,937.8 1449,1378,955.3; do
    "$petroglyph" pick "$project" --at $place --horizon B
done
"$petroglyph" horizon fill "$project" B
"$petroglyph" layer set "$project" "above B" --pattern shale
"$petroglyph" layer set "$project" "below B" --pattern sandstone-bedded
"$petroglyph" render "$project" "$pictures/penobscot-picks.png" --blend 0.4 --exaggeration 5 --azimuth 225 --ground off --size 1400x900

# F3 around well F02-1: five horizons tied to the tops of the well, layers named and patterned by what it drilled.
project=$out/f02-1.petro
rm -rf "$project"
"$petroglyph" import "$data/volumes/f3_depth_il300-427_xl300-439_int16.sgy" "$project"
"$petroglyph" raw "$project" --volume seismic --map grey
"$petroglyph" extract "$project" --fault-evidence 200
"$petroglyph" well add "$project" "$data/wells/F02-1_deviation.csv" --tops "$data/wells/F02-1_tops.csv" --name F02-1 --kb 36
tie() { for place in "${@:2}"; do "$petroglyph" pick "$project" --at $place --horizon "$1" --highest-valid; done; }
tie "Middle North Sea Group" 362,336,1250 359,424,1270.9
tie "Dongen Clay" 362,336,1423 405,318,1457.8 317,324,1385.5 385,354,1442.1
tie "Dongen Tuffite" 362,336,1619
tie "Ekofisk" 362,336,1659
tie "Ommelanden" 362,336,1691 347,383,1663.5 321,417,1658.7
for name in "Middle North Sea Group" "Dongen Clay" "Ommelanden"; do
    "$petroglyph" horizon fill "$project" "$name"
done
named() { "$petroglyph" layer set "$project" "$1" --name "$2" "${@:3}"; }
named "above Middle North Sea Group" "Upper North Sea Gp (clay, silt)" --pattern siltstone --colour "#e9e2c0"
named "Middle North Sea Group - Dongen Clay" "Middle North Sea Gp (clay)" --pattern shale --colour "#b9c4a3"
named "Dongen Clay - Dongen Tuffite" "Dongen Clay" --pattern shale --colour "#93a58c"
named "Dongen Tuffite - Ekofisk" "Dongen Tuffite, Landen Clay" --interval 0,0.7,shale --interval 0.7,1,tuff
named "Ekofisk - Ommelanden" "Ekofisk Fm (chalk)" --pattern chalk --colour "#dfe9ee"
named "below Ommelanden" "Ommelanden Fm (chalk, chert)" --pattern limestone-cherty --colour "#b5d0dc"
"$petroglyph" render "$project" "$pictures/f02-1.png" --exaggeration 3 --azimuth 145 --elevation 25 --ground off --legend \
    --cut nearest,0.5175,0.5 --size 1700x880

# F3 without interpretation.
rm -rf "$out/illustrate-f3.petro"
"$petroglyph" illustrate "$data/volumes/f3_depth_il300-427_xl300-439_int16.sgy" "$pictures/illustrate-f3.png" --project "$out/illustrate-f3.petro"
rm -rf "$out/illustrate-f3-salt.petro"
"$petroglyph" illustrate "$data/volumes/f3_depth_il300-427_xl720-975_int16.sgy" "$pictures/illustrate-f3-salt.png" --project "$out/illustrate-f3-salt.petro"
