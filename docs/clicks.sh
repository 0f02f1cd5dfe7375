#!/usr/bin/env bash
# Counts what clicks by geologic time find of Penobscot's Horizon B, for docs/time.md: without faults, with the four faults
# of docs/real-data.md, and with all seven that sections show. PETROGLYPH_DATA is the folder with the data files, $1 the
# folder for projects; needs `cargo build --example clicks`.
set -euo pipefail
data=${PETROGLYPH_DATA:?set PETROGLYPH_DATA to the folder with the real data}
out=${1:-out/clicks}
petroglyph=${PETROGLYPH:-target/debug/petroglyph}
clicks=${CLICKS:-target/debug/examples/clicks}
mkdir -p "$out"

count() {
    local project=$out/$1.petro
    rm -rf "$project"
    "$petroglyph" import "$data/volumes/penobscot_il1207-1456_xl1253-1402_t876-1032_int16.sgy" "$project"
    "$petroglyph" extract "$project" --fault-evidence 100
    "${@:2}" "$project"
    # The interpretation is added afterwards, so that it is only compared with.
    "$petroglyph" time "$project"
    "$petroglyph" horizon add "$project" "$data/interpretation/penobscot_horizon_B/opendtect_xy_ilxl.dat" --name B --z-unit ms
    echo "== $1"
    "$clicks" "$project" B 3 15
}

fault() { "$petroglyph" fault pick "$1" --name "$2" "${@:4}" && "$petroglyph" fault extent "$1" "$2" grow "$3"; }

none() { :; }

four() {
    fault "$1" "South-west fault" 250 --stick 1307,1258,912 1300,1258,1000 --stick 1297,1268,920 1288,1268,1000 \
        --stick 1284,1280,928 1277,1280,1000 --stick 1277,1291,956 1271,1291,1008
    fault "$1" "West fault" 250 --stick 1292,1305,932 1286,1305,980 --stick 1267,1323,951 1262,1323,984 \
        --stick 1258,1335,960 1253,1335,996
    fault "$1" "North-west fault" 250 --stick 1268,1375,984 1264,1375,1020 --stick 1272,1393,988 1268,1393,1020
    fault "$1" "North-east fault" 250 --stick 1435,1343,972 1429,1343,1020 --stick 1433,1360,960 1430,1360,1000 \
        --stick 1435,1374,956 1431,1374,1008 --stick 1435,1388,944 1429,1388,1024 --stick 1433,1400,956 1429,1400,1012
}

seven() {
    four "$1"
    fault "$1" "East fault" 120 --stick 1421.5,1291,940 1419,1291,1000 --stick 1426,1298,935 1423,1298,990 \
        --stick 1429,1305,940 1427.5,1305,1010 --stick 1437,1313,935 1434,1313,1000 --stick 1447.5,1323,930 1444,1323,990 \
        --stick 1450,1331,930 1447,1331,990 --stick 1448,1339,935 1446,1339,1000 --stick 1448.5,1348,940 1446,1348,1000 \
        --stick 1447.5,1358,945 1445,1358,990
    fault "$1" "South fault" 120 --stick 1388,1261,930 1387,1261,980 --stick 1400.5,1273,930 1400,1273,980 \
        --stick 1408.5,1285,935 1408.5,1285,980 --stick 1412,1291,940 1411,1291,980 --stick 1417,1298,945 1416,1298,990
    fault "$1" "Graben's south wall" 120 --stick 1424,1348,985 1422,1348,1020 --stick 1416,1358,980 1414.5,1358,1015 \
        --stick 1414.5,1368,985 1412,1368,1020 --stick 1420,1378,1000 1417,1378,1030
}

for faults in none four seven; do count $faults $faults; done
