#!/usr/bin/env python3
"""Switches the layers of a PDF off one by one, as a reader does in a viewer, and says how many pixels that changes.

    venv/bin/python bench/switched_layers.py FILE.pdf

needs qpdf (with fix-qdf), mutool, numpy, pillow and pypdfium2. A line for each layer: its name and the pixels that changed
at 100 dots an inch as mutool draws the page, and as PDFium does, which is what Chrome shows PDFs with.
"""
import os
import re
import subprocess
import sys
import tempfile

import numpy
import pypdfium2
from PIL import Image


def drawn(folder, pdf):
    """The page as mutool and as PDFium draw it."""
    path = os.path.join(folder, "page.pdf")
    picture = os.path.join(folder, "page.png")
    with open(path, "wb") as file:
        file.write(subprocess.run(["fix-qdf"], input=pdf, capture_output=True, check=True).stdout)
    subprocess.run(["mutool", "draw", "-q", "-r", "100", "-o", picture, path, "1"], check=True, capture_output=True)
    pictures = Image.open(picture), pypdfium2.PdfDocument(path)[0].render(scale=100 / 72).to_pil()
    return [numpy.asarray(drawn.convert("RGB")).astype(int) for drawn in pictures]


def name_of(written):
    """A string of a PDF as it is read: in brackets, or in hexadecimal digits as UTF-16."""
    if written.startswith(b"<"):
        return bytes.fromhex(written[1:-1].decode()).decode("utf-16")
    return re.sub(rb"\\(.)", rb"\1", written[1:-1]).decode("latin-1")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    plain = ["qpdf", "--qdf", "--object-streams=disable", "--no-original-object-ids", sys.argv[1], "-"]
    pdf = subprocess.run(plain, capture_output=True, check=True).stdout
    layers = []
    for number, body in re.findall(rb"(\d+) 0 obj\n<<(.*?)\n>>\nendobj", pdf, re.S):
        if b"/Type /OCG" in body:
            layers.append((number, name_of(re.search(rb"/Name (\((?:\\.|[^)])*\)|<[^>]*>)", body).group(1))))
    with tempfile.TemporaryDirectory() as folder:
        before = drawn(folder, pdf)
        for number, name in layers:
            off = re.sub(rb"/OCProperties <<\s*/D <<", rb"\g<0>\n/OFF [ " + number + b" 0 R ]", pdf, count=1)
            pairs = zip(drawn(folder, off), before)
            changed = [(numpy.abs(after - before).max(axis=2) > 8).sum() for after, before in pairs]
            print(f"{name}: {changed[0]}, {changed[1]}")


main()
