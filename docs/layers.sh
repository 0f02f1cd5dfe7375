#!/usr/bin/env bash
# Measures a block of very many layers: the tables of docs/performance.md.
#   docs/layers.sh HORIZONS [FOLDER]
# makes a project of gently folded horizons, every second layer with a pattern of its own, and draws it as PNG, SVG and
# PDF with everything that can be written on it: seconds of processor time, most memory and size of each. Files are left in FOLDER. It
# needs GNU time and Python.
set -euo pipefail
horizons=$1
folder=${2:-out/layers-$horizons}
petroglyph=${PETROGLYPH:-target/debug/petroglyph}
project=$folder/layers.petro
quietly() { "$petroglyph" "$@" > /dev/null; }

if [ ! -d "$project" ]; then
    mkdir -p "$folder/horizons"
    deepest=$(python3 - "$horizons" "$folder/horizons" << 'PYTHON'
import math
import sys

count, folder = int(sys.argv[1]), sys.argv[2]
for n in range(count):
    with open(f"{folder}/{n}.csv", "w", encoding="utf-8") as file:
        file.write("x,y,z\n")
        for x in range(0, 4001, 100):
            for y in range(0, 3001, 100):
                z = 200 + 20 * n + 120 * math.sin(x / 700) * math.cos(y / 1100)
                file.write(f"{x},{y},{z:.3f}\n")
print(20 * count + 380)
PYTHON
    )
    quietly create "$project" --bounds "0,4000,0,3000,0,$deepest" --size "81x61x$((deepest / 20 + 1))"
    patterns=(shale limestone sandstone-bedded marl dolostone siltstone chalk conglomerate)
    for ((n = 0; n < horizons; n++)); do
        quietly horizon add "$project" "$folder/horizons/$n.csv" --name "H$n"
        if ((n > 0 && n % 2 == 0)); then
            quietly layer set "$project" "H$((n - 1)) - H$n" --pattern "${patterns[$((n / 2 % 8))]}"
        fi
    done
fi

echo "| file | processor, s | most memory, MB | size, MB |"
echo "|---|---|---|---|"
for ending in png svg pdf; do
    file=$folder/layers.$ending
    /usr/bin/time -f "%U %S %M" -o "$folder/spent" "$petroglyph" render "$project" "$file" --cut nearest,0.45,0.45 \
        --size-cm 17x11.5 --dpi 220 --annotate all > "$folder/told" 2> "$folder/warned"
    read -r own system kilobytes < <(tail -1 "$folder/spent")
    seconds=$(awk "BEGIN { print $own + $system }")
    echo "| $ending | $seconds | $((kilobytes / 1000)) | $(awk -v bytes="$(stat -c %s "$file")" 'BEGIN { printf("%.1f", bytes / 1e6) }') |"
done
