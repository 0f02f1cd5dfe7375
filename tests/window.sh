#!/bin/sh
# Drives the real window on a display of its own: opens a project, turns the block, looks at sections and map, exports.
#
#   tests/window.sh PROGRAM PROJECT OUT_DIR [WIDTHxHEIGHT]
#
# Leaves screenshots and the exported picture in OUT_DIR. Skips with a message and exit code 0 if Xvfb, xdotool or
# ImageMagick's import is missing.
set -eu

program=$1 project=$2 out=$3 size=${4:-1280x800}
for tool in Xvfb xdotool import; do
    command -v "$tool" >/dev/null || { echo "skipped: $tool is not installed"; exit 0; }
done
mkdir -p "$out"
width=${size%x*} height=${size#*x}

# A display that nobody else uses: Xvfb chooses it and prints its number.
exec 3>"$out/display"
Xvfb -displayfd 3 -screen 0 "${size}x24" >"$out/xvfb.log" 2>&1 &
server=$!
trap 'kill "${window_process:-}" "$server" 2>/dev/null || true' EXIT INT TERM
until [ -s "$out/display" ]; do sleep 0.1; done
DISPLAY=:$(cat "$out/display")
export DISPLAY XDG_CONFIG_HOME="$out/settings" XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-/tmp}"
unset WAYLAND_DISPLAY || true

"$program" view "$project" >"$out/window.log" 2>&1 &
window_process=$!
window=$(timeout 120 xdotool search --sync --onlyvisible --name 'Petroglyph$' | head -n 1)
xdotool windowmove "$window" 0 0 windowsize "$window" "$width" "$height"
xdotool windowfocus "$window"

look() { sleep "${2:-4}"; import -window root "$out/$1.png"; echo "$out/$1.png"; }
key() { xdotool key --clearmodifiers "$@"; sleep 0.4; }
alive() { kill -0 "$window_process" || { echo "the window ended:"; cat "$out/window.log"; exit 1; }; }

look 1-block 14
alive
# Turn the block by hand: from the middle of the picture to the right.
middle_x=$((width / 2)) middle_y=$((height / 2))
xdotool mousemove "$middle_x" "$((middle_y + 150))" mousedown 1
sleep 0.6
for step in 1 2 3 4 5 6 7 8; do xdotool mousemove_relative -- 15 -4; sleep 0.3; done
xdotool mouseup 1
look 2-turned 8
key s; look 3-side-by-side 10
key w; look 4-wipe 10
key b
key 2; look 5-sections 10
key 3; look 6-map 8
key 1
key question; look 7-shortcuts 2
key Escape
key d; look 8-data 2
key l
key ctrl+e; look 9-export 2
key Escape
alive
key ctrl+w
look 10-start 2
kill "$window_process"
wait "$window_process" 2>/dev/null || true
echo "done"
