#!/usr/bin/env bash
# Measures how other programs draw our SVG and PDF, and checks the files: the tables of docs/likeness.md.
#   docs/likeness.sh DEMO.petro REAL_FOLDER [FOLDER]
# DEMO.petro is the project of `make demo`, REAL_FOLDER the projects of docs/real-data.sh; files are left in FOLDER.
# It needs rsvg-convert, pdftoppm, pdftotext, mutool, qpdf, and Python with numpy and Pillow.
set -euo pipefail
demo=$1
real=$2
folder=${3:-out/likeness}
here=$(dirname "$0")/..
measure() { python3 "$here/bench/likeness.py" "$1" "$folder" "${@:2}"; }

echo "| figure | faces: rsvg | pdftoppm | mutool | whole: rsvg | pdftoppm | mutool | moved by three pixels |"
echo "|---|---|---|---|---|---|---|---|"
measure Demo "$demo" --cut nearest,0.45,0.45 --blend 0
measure Claudius "$real/claudius.petro" --cut min-min,0.45,0.6 --exaggeration 2 --azimuth 35 --elevation 25 --ground off
measure F3 "$real/f3.petro" --blend 0 --exaggeration 2.5 --azimuth 145 --elevation 25 --ground off \
    --box 300,427,756,920,1186.8,1826.4 --cut nearest,0.25,0.6
measure Penobscot "$real/penobscot.petro" --blend 0 --exaggeration 5 --azimuth 225 --ground off --cut nearest,0.4,0.5

echo
echo "| figure | PNG, SVG, PDF in KB | qpdf --check | mutool | layers in the PDF | words by pdftotext |"
echo "|---|---|---|---|---|---|"
for name in Demo Claudius F3 Penobscot; do
    sizes=$(for ending in png svg pdf; do stat -c %s "$folder/$name.$ending"; done | awk '{ printf("%s%.0f", (NR > 1 ? ", " : ""), $1 / 1000) }')
    checked=$(qpdf --check "$folder/$name.pdf" 2>&1 | grep -c "No syntax or stream encoding errors" || true)
    said=$(mutool draw -q -r 40 -o /dev/null -F ppm "$folder/$name.pdf" 2>&1 | wc -l)
    layers=$(mutool show "$folder/$name.pdf" grep 2> /dev/null | grep -c "/Type/OCG" || true)
    words=$(pdftotext -layout "$folder/$name.pdf" - | wc -w)
    echo "| $name | $sizes | $([ "$checked" = 1 ] && echo "no errors" || echo failed) | $said warnings | $layers | $words |"
done
