#!/usr/bin/env python3
"""Compares the figures of a project as other programs draw them from SVG and PDF with our own PNG.

    python3 -m venv venv && venv/bin/pip install numpy pillow
    venv/bin/python bench/likeness.py NAME FOLDER PROJECT [options of `petroglyph render`]

draws PROJECT twice with these options: as an annotated page (NAME.png, .svg, .pdf in FOLDER: the whole), and as a block
alone on nothing (NAME-faces). rsvg-convert, pdftoppm and mutool then draw the SVG and the PDF in as many pixels. One row of
Markdown is printed: the structural similarity of each with our picture. docs/likeness.sh makes the table of docs/likeness.md.

The measure: brightness on white paper, each pixel the mean of the 5 x 5 pixels around it (a blur of two pixels), then
structural similarity (Wang et al., "Image quality assessment", 2004) in windows of 8 x 8 pixels, every 4 pixels, averaged
over windows that are not paper in both pictures. On faces only windows count that lie wholly in what is drawn as
paths: the relief of the ground, which is the same picture in all files, is taken out. The last column tells what the measure is worth: the
same picture moved by three pixels.

PETROGLYPH names the program (default target/debug/petroglyph).
"""
import os
import re
import subprocess
import sys

import numpy
from PIL import Image

DPI = 220
WINDOW, EVERY = 8, 4
C1, C2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(command)}: {done.stderr.strip()}")
    return done.stdout


def sums(values, side):
    """Sums over squares of `side` pixels."""
    total = numpy.zeros((values.shape[0] + 1, values.shape[1] + 1))
    total[1:, 1:] = values.cumsum(0).cumsum(1)
    return total[side:, side:] - total[:-side, side:] - total[side:, :-side] + total[:-side, :-side]


def brightness(picture):
    paper = Image.new("RGBA", picture.size, "white")
    rgb = numpy.asarray(Image.alpha_composite(paper, picture.convert("RGBA")), dtype=float)[..., :3]
    return sums(numpy.pad(rgb @ [0.299, 0.587, 0.114], 2, mode="edge"), 5) / 25


def likeness(a, b, mask=None):
    a, b = brightness(a), brightness(b)
    n = WINDOW * WINDOW
    mean_a, mean_b = (sums(values, WINDOW) / n for values in (a, b))
    var_a, var_b = (sums(values**2, WINDOW) / n - mean**2 for values, mean in ((a, mean_a), (b, mean_b)))
    both = sums(a * b, WINDOW) / n - mean_a * mean_b
    alike = (2 * mean_a * mean_b + C1) * (2 * both + C2) / ((mean_a**2 + mean_b**2 + C1) * (var_a + var_b + C2))
    counted = sums(((a < 254) | (b < 254)).astype(float), WINDOW) > 0
    if mask is not None:
        counted &= sums(mask.astype(float), WINDOW) == n
    alike, counted = alike[::EVERY, ::EVERY], counted[::EVERY, ::EVERY]
    return alike[counted].mean()


def drawn_by_others(stem, size):
    """The pictures that other programs make of STEM.svg and STEM.pdf, all of one size."""
    width, height = map(str, size)
    run("rsvg-convert", "-w", width, "-h", height, f"{stem}.svg", "-o", f"{stem}-rsvg.png")
    run("pdftoppm", "-png", "-singlefile", "-scale-to-x", width, "-scale-to-y", height, f"{stem}.pdf", f"{stem}-pdftoppm")
    run("mutool", "draw", "-q", "-w", width, "-h", height, "-f", "-o", f"{stem}-mutool.png", f"{stem}.pdf", "1")
    return [Image.open(f"{stem}-{name}.png") for name in ("rsvg", "pdftoppm", "mutool")]


def paths_alone(stem, size):
    """Where the SVG draws paths: drawn without its images."""
    with open(f"{stem}.svg", encoding="utf-8") as file:
        text = re.sub(r"<image\b[^>]*/>", "", file.read())
    with open(f"{stem}-paths.svg", "w", encoding="utf-8") as file:
        file.write(text)
    width, height = map(str, size)
    run("rsvg-convert", "-w", width, "-h", height, f"{stem}-paths.svg", "-o", f"{stem}-paths.png")
    return numpy.asarray(Image.open(f"{stem}-paths.png").convert("RGBA"))[..., 3] > 250


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    name, folder, project, *options = sys.argv[1:]
    petroglyph = os.environ.get("PETROGLYPH", "target/debug/petroglyph")
    os.makedirs(folder, exist_ok=True)
    page = [*options, "--size-cm", "17x11.5", "--dpi", str(DPI), "--samples", "4"]
    cells = [name]
    for stem, more in ((f"{folder}/{name}-faces", ["--background", "transparent"]), (f"{folder}/{name}", ["--annotate", "all"])):
        for ending in ("png", "svg", "pdf"):
            run(petroglyph, "render", project, f"{stem}.{ending}", *page, *more)
        ours = Image.open(f"{stem}.png")
        is_faces = stem.endswith("-faces")
        mask = paths_alone(stem, ours.size) if is_faces else None
        others = drawn_by_others(stem, ours.size)
        cells += [f"{likeness(ours, other, mask):.3f}" for other in others]
        if is_faces:
            moved = Image.fromarray(numpy.roll(numpy.asarray(ours), 3, axis=1))
            off = f"{likeness(ours, moved, mask):.3f}"
    print(f"| {' | '.join([*cells, off])} |")


main()
