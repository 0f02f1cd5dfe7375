#!/usr/bin/env bash
# Measures a block of very many layers: the table of docs/performance.md.
#   docs/layers.sh HORIZONS [FOLDER]
# makes a project of gently folded horizons (three or more, all layers with the patterns that they have by default), and
# draws it as PNG, SVG and PDF with everything that can be written on it: seconds of processor time, most memory and size
# of each. Files are left in FOLDER. It needs GNU time and Python.
set -euo pipefail
horizons=$1
folder=${2:-out/layers-$horizons}
petroglyph=${PETROGLYPH:-target/debug/petroglyph}
project=$folder/layers.petro
quietly() { "$petroglyph" "$@" > /dev/null; }

if [ ! -d "$project" ]; then
    mkdir -p "$folder"
    deepest=$(python3 - "$horizons" "$folder" << 'PYTHON'
import math
import sys

count, folder = int(sys.argv[1]), sys.argv[2]
for name, depth in (("Top", 200), ("Base", 200 + 20 * (count - 1))):
    with open(f"{folder}/{name}.csv", "w", encoding="utf-8") as file:
        file.write("x,y,z\n")
        for x in range(0, 4001, 50):
            for y in range(0, 3001, 50):
                file.write(f"{x},{y},{depth + 120 * math.sin(x / 700) * math.cos(y / 1100):.3f}\n")
print(20 * count + 380)
PYTHON
    )
    quietly create "$project" --bounds "0,4000,0,3000,0,$deepest" --size "81x61x$((deepest / 20 + 1))"
    for name in Top Base; do
        quietly horizon add "$project" "$folder/$name.csv" --name $name
    done
    quietly horizon stack "$project" Bed --count $((horizons - 2)) --between Top Base --spacing proportional
fi

echo "| file | processor, s | most memory, MB | size, MB |"
echo "|---|---|---|---|"
for ending in png svg pdf; do
    file=$folder/layers.$ending
    /usr/bin/time -f "%U %S %M" -o "$folder/spent" "$petroglyph" render "$project" "$file" --cut nearest,0.45,0.45 \
        --size-cm 17x11.5 --dpi 220 --annotate all --outlines on > "$folder/told" 2> "$folder/warned"
    read -r own system kilobytes < <(tail -1 "$folder/spent")
    awk -v file="$ending" -v own="$own" -v kernel="$system" -v kb="$kilobytes" -v bytes="$(stat -c %s "$file")" \
        'BEGIN { printf("| %s | %.1f | %d | %.1f |\n", file, own + kernel, kb / 1000, bytes / 1e6) }'
done
