#!/usr/bin/env python3
"""Tests the recipes of ARCHITECTURE.md, "What do I touch to add": a copy of the checkout gets one attribute, one pattern and one export format more, by
edits of the files that the page lists and of no others; the crates are checked, and the test that the recipe relies on is run.

    python3 tests/recipes.py [NAME …] [--list]

With --list the edits are applied and counted, and nothing is built. The copy is in target/recipes. Needs git and cargo."""
import argparse
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COPY = ROOT / "target/recipes/tree"


@dataclass
class Edit:
    """Text that goes behind the first line that has `behind` in it, or a new file."""

    file: str
    text: str
    behind: str | None = None
    instead: bool = False

    def apply(self, root):
        path = root / self.file
        if self.behind is None:
            if path.exists():
                sys.exit(f"{self.file} is there already")
            path.write_text(self.text, encoding="utf-8")
            return
        before = path.read_text(encoding="utf-8")
        if self.behind not in before:
            sys.exit(f"{self.file} has no place for the edit: {self.behind}")
        at = before.index(self.behind)
        behind = at + len(self.behind)
        path.write_text(before[: at if self.instead else behind] + self.text + before[behind:], encoding="utf-8")


@dataclass
class Recipe:
    """What is touched, the crates that must still compile, and the tests that must pass."""

    title: str
    edits: list
    check: list
    tests: list

    def files(self):
        return sorted({edit.file for edit in self.edits})


PYTHON = "crates/python/python/petroglyph/_commands.py"
ATTRIBUTE = Recipe(
    "an attribute",
    [
        Edit(
            "crates/attribute/src/magnitude.rs",
            '''//! Magnitude: how far samples are from zero.

use super::dip::like;
use super::error::AttributeError;
use survey::progress::Progress;
use survey::volume::Volume;

/// Computes the magnitude of every sample.
///
/// # Errors
/// [`AttributeError::Cancelled`].
///
/// # Examples
/// ```
/// use survey::{progress::Progress, volume::Volume};
///
/// let volume = Volume::from_samples([1, 1, 2], vec![-3.0, 2.0])?;
/// let magnitude = attribute::magnitude(&volume, &Progress::silent())?;
/// assert_eq!(magnitude.trace(0, 0), [3.0, 2.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn magnitude(volume: &Volume<f32>, progress: &Progress) -> Result<Volume<f32>, AttributeError> {
    let [nx, ny, _] = volume.size();
    progress.begin("magnitude", 1);
    let traces = (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y)));
    let out = traces.flat_map(|(x, y)| volume.trace(x, y).iter().map(|sample| sample.abs())).collect();
    progress.step(1)?;
    Ok(like(volume, out))
}
''',
        ),
        Edit("crates/attribute/src/lib.rs", "\nmod magnitude;", "mod error;"),
        Edit("crates/attribute/src/lib.rs", "\npub use magnitude::magnitude;", "pub use error::AttributeError;"),
        Edit("crates/attribute/src/blocks.rs", "\nuse super::magnitude::magnitude;", "use super::error::AttributeError;"),
        Edit(
            "crates/attribute/src/blocks.rs",
            '''/// The magnitude of a volume.
pub fn magnitude_blocks(source: &dyn BoxSource) -> AttributeBlocks<'_> {
    computed(source, 0, magnitude)
}

/// The envelope of a volume.''',
            "/// The envelope of a volume.",
            instead=True,
        ),
        Edit(
            "crates/project/src/document/origin.rs",
            "\n    /// Magnitude: how far samples are from zero.\n    Magnitude,",
            "    Envelope,",
        ),
        Edit("crates/project/src/document/origin.rs", "[Self; 8] =", "[Self; 7] =", instead=True),
        Edit("crates/project/src/document/origin.rs", "[Self::Magnitude, Self::Semblance, ", "[Self::Semblance, ", instead=True),
        Edit("crates/project/src/document/origin.rs", '\n            Self::Magnitude => "magnitude",', 'Self::Envelope => "envelope",'),
        Edit(
            "crates/project/src/command/attribute.rs",
            '''
            AttributeKind::Magnitude => {
                write(out[0], attribute::blocks::magnitude_blocks(&source), memory_bytes, progress)?;
            }''',
            "match self.kind {\n            AttributeKind::Envelope => write(out[0], envelope_blocks(&source), memory_bytes, progress)?,",
        ),
        Edit(
            "crates/project/src/command/attribute.rs",
            "AttributeKind::Magnitude\n            | AttributeKind::Semblance\n",
            "AttributeKind::Semblance\n",
            instead=True,
        ),
        Edit("src/cli/args/attribute.rs", "semblance|magnitude|envelope|dip", "semblance|envelope|dip", instead=True),
        Edit(PYTHON, 'kind: Literal["semblance", "magnitude"', 'kind: Literal["semblance"', instead=True),
        Edit(PYTHON, 'kind : {"semblance", "magnitude"', 'kind : {"semblance"', instead=True),
    ],
    ["petroglyph"],
    [["-p", "attribute", "--doc", "magnitude"]],
)

PATTERN = Recipe(
    "a pattern",
    [
        Edit(
            "crates/ttf/examples/draw_patterns/crystalline.rs",
            '''
/// Short level strokes.
pub fn strokes() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(1));
    for point in tile.scatter(&mut dice, 5.3, &[], 0.0) {
        tile.line([point[0] - 1.7, point[1]], [point[0] + 1.7, point[1]], LINE);
    }
    tile
}

/// 719: short''',
            "\n/// 719: short",
            instead=True,
        ),
        Edit(
            "crates/ttf/examples/draw_patterns/main.rs",
            '\n    ("strokes", crystalline::strokes),',
            '("granite", crystalline::granite),',
        ),
        Edit("crates/ttf/src/builtin.rs", '\n    "strokes",', '    "granite",'),
        # What `draw_patterns` overwrites.
        Edit("textures/strokes.svg", ""),
        Edit(
            "textures/catalogue.toml",
            '''[[pattern]]
name = "strokes"
title = "Strokes"
description = "Short level strokes."
family = "plutonic"
tile_mm = [21.167, 21.167]
directional = true
colour = "#edc0b0"

[[pattern]]
name = "granite"
''',
            '[[pattern]]\nname = "granite"\n',
            instead=True,
        ),
    ],
    ["ttf"],
    [["-p", "ttf", "--test", "patterns"]],
)

FORMAT = Recipe(
    "a horizon format",
    [
        Edit(
            "crates/files/src/plain.rs",
            '''//! Plain: `inline crossline x y z` of every node, under a line that says so.

use super::column::Column;
use super::columns::ColumnLayout;
use super::raw::{RawSurface, ReadContext};
use super::table::{self, LineCut};
use super::text::{self, SourceFile};
use super::write::{self, TableNode};
use super::{Codec, Format, FormatError, HorizonWriter};
use std::io::Write;
use survey::geometry::SurveyGeometry;
use survey::horizon::Horizon;

pub(super) const CODEC: Codec = Codec {
    format: Format::Plain,
    name: "plain",
    extension: "plain",
    detect,
    read_horizon: Some(read),
    read_fault: None,
    write_horizon: Some(HorizonWriter::of(write_horizon)),
    write_fault: None,
};

fn detect(source: &SourceFile) -> Option<String> {
    source.text().starts_with("# plain").then(|| "its first line is '# plain'".to_owned())
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let text = source.text();
    let layout = ColumnLayout::plain(vec![Column::Inline, Column::Crossline, Column::X, Column::Y, Column::Z]);
    let rows: Vec<_> = text::lines(&text).filter(|l| !table::is_comment(l.text)).collect();
    let cut = LineCut::of(rows.first().map_or("", |l| l.text));
    table::surfaces(source, &rows, cut, layout, context)
}

fn write_horizon(out: &mut dyn Write, horizon: &Horizon, geometry: &SurveyGeometry) -> Result<(), write::WriteFailure> {
    writeln!(out, "# plain")?;
    for TableNode { lines, xy, z, .. } in write::nodes(horizon, geometry) {
        let [il, xl] = [lines.x, lines.y].map(write::line_number);
        writeln!(out, "{il} {xl} {:.4} {:.4} {z}", xy.x, xy.y)?;
    }
    Ok(())
}
''',
        ),
        Edit("crates/files/src/lib.rs", "\nmod plain;", "mod placement;"),
        Edit("crates/files/src/lib.rs", "\n    /// The lines and the place of every node.\n    Plain,", "    Dxf,"),
        Edit("crates/files/src/lib.rs", "\n    plain::CODEC,", "    tsurf::CODEC,"),
    ],
    ["petroglyph"],
    [["-p", "files", "--lib", "round_trips"]],
)

RECIPES = {"attribute": ATTRIBUTE, "pattern": PATTERN, "format": FORMAT}


def copy():
    """A copy of what is under version control."""
    shutil.rmtree(COPY, ignore_errors=True)
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True).stdout
    for name in listed.decode().split("\0"):
        if name and (ROOT / name).is_file():
            (COPY / name).parent.mkdir(parents=True, exist_ok=True)
            # With its times, so that what has not changed is not built again.
            shutil.copy2(ROOT / name, COPY / name)
    for recipe in RECIPES.values():
        # What the recipe before has changed is older now than what was built of it.
        for file in filter(Path.exists, (COPY / name for name in recipe.files())):
            file.touch()


def unlisted(recipe):
    """The files that are touched and that the page does not list."""
    page = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    found = re.search(rf"^- \*\*{recipe.title}\*\*(.*?)(?=^- |^#|\Z)", page, re.M | re.S)
    if not found:
        return recipe.files()
    listed = re.findall(r"`([^`]+)`", found[1])
    return [file for file in recipe.files() if not any(file == one or file.startswith(one.rstrip("/") + "/") for one in listed)]


def cargo(*arguments):
    environment = {**os.environ, "CARGO_TARGET_DIR": str(ROOT / "target/recipes/target")}
    return subprocess.run(["cargo", *arguments], cwd=COPY, env=environment).returncode == 0


def works(name, recipe, builds):
    """Tries one recipe; says what it touches."""
    copy()
    for edit in recipe.edits:
        edit.apply(COPY)
    print(f"{name}: {len(recipe.files())} files: {', '.join(recipe.files())}", flush=True)
    missing = unlisted(recipe)
    if missing:
        print(f'{name}: ARCHITECTURE.md, "{recipe.title}", does not list {", ".join(missing)}')
    # Its drawing is made by a program.
    if builds and recipe is PATTERN and not cargo("run", "-q", "--locked", "-p", "ttf", "--example", "draw_patterns"):
        return False
    checks = [["check", "--locked", *(part for crate in recipe.check for part in ("-p", crate))]]
    steps = checks + [["test", "--locked", *test] for test in recipe.tests]
    return not missing and (not builds or all(cargo(*step) for step in steps))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipes", nargs="*", metavar="NAME", help=f"some of {', '.join(RECIPES)}; all if none is named")
    parser.add_argument("--list", action="store_true")
    typed = parser.parse_args()
    failed = [name for name in typed.recipes or RECIPES if not works(name, RECIPES[name], not typed.list)]
    if failed:
        sys.exit(f"recipes that do not work: {', '.join(failed)}")


if __name__ == "__main__":
    main()
