#!/usr/bin/env python3
"""Measures how the code is divided, for docs/house.md, which says what each row means: a Markdown table with a column for each checkout.

    python3 bench/house.py [ROOT …]                 # the checkout that this script lies in, if none is named
    python3 bench/house.py before=OLD after=. --build   # with names for columns, and what a build from cold costs
    python3 bench/house.py --json                   # the same as JSON
    python3 bench/house.py --walk pick              # a journey, stay by stay

Only Python's standard library is needed, and git for the lines of Python."""
import argparse
import json
import os
import re
import resource
import statistics
import subprocess
import tempfile
from collections import Counter
from pathlib import Path

from journeys import Index, Walk
from rust_source import Workspace

# Where the journeys begin: a function by its module or type, and the parameter that is followed.
JOURNEYS = {"render": "page::draw:project", "pick": "PickNode::execute:draft"}
ITEMS = ("fn", "struct", "enum", "trait", "const", "static", "type", "mod", "unsafe", "async")
PANICS = re.compile(r"\.unwrap\(\)|\.expect\(|\bpanic!|\bunreachable!|\btodo!")


def journeys(workspace):
    """Stays and returns of each journey in the crates that know a project, with and without what modules hand on."""
    index = Index(workspace)
    rooms = {name for name, built_on in workspace.dependencies.items() if name == "project" or "project" in built_on}
    for name, start in JOURNEYS.items():
        for behind_doors in (False, True):
            yield name, behind_doors, Walk(index, start, rooms, behind_doors)


def lines_of_python(root):
    """Lines of the Python package that are under version control."""
    package = "crates/python/python"
    listed = subprocess.run(["git", "-C", root, "ls-files", "-z", f"{package}/*.py"], check=True, capture_output=True, text=True)
    files = [Path(root, name) for name in listed.stdout.split("\0") if name]
    return sum(file.read_text(encoding="utf-8").count("\n") for file in files if file.exists())


def build_cost(root):
    """Processor seconds of a build from cold, and how many crates it compiles."""
    with tempfile.TemporaryDirectory() as target:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        command = ["cargo", "build", "--workspace", "--locked", "--bin", "petroglyph"]
        environment = {**os.environ, "CARGO_TARGET_DIR": target, "CARGO_TERM_COLOR": "never"}
        said = subprocess.run(command, cwd=root, env=environment, check=True, stderr=subprocess.PIPE, text=True).stderr
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"build, processor seconds": round(seconds), "build, crates compiled": len(re.findall(r"^\s*Compiling ", said, re.M))}


def measures(root, builds):
    """All that is measured of a checkout, by the words of docs/house.md."""
    workspace = Workspace(root)
    files, found = workspace.files, {}
    for name, behind_doors, walk in journeys(workspace):
        where = ", behind the doors of modules" if behind_doors else ""
        found[f"{name}: stays / returns{where}"] = f"{len(walk.stays())} / {walk.returns()}"
    code = sum(len(source.code_lines) for source in files)
    pairs = [pair for source in files for pair in zip(source.words, source.words[1:])]
    types = Counter(name for word, name in pairs if word in ("struct", "enum", "trait") and name[0].isupper())
    lengths = [source.text.count("\n") for source in files]
    # Texts are no words any more, so a panic in one is none here.
    panics = sum(len(PANICS.findall("".join(source.words))) for source in files)
    found |= {
        "lines of code": code,
        "lines with comments and blank lines": sum(source.lines for source in files),
        "lines of the Python package": lines_of_python(root),
        "crates": len(workspace.crates),
        "public items": sum(word == "pub" and next_word in ITEMS for word, next_word in pairs),
        "type names used twice or more": f"{sum(count > 1 for count in types.values())} of {len(types)}",
        "unwrap, expect, panic a thousand lines": round(1000 * panics / sum(source.lines for source in files), 2),
        "lines of a file, median / 90 % / longest": " / ".join(
            str(round(n)) for n in (statistics.median(lengths), statistics.quantiles(lengths, n=10)[-1], max(lengths))
        ),
    }
    return found | (build_cost(root) if builds else {})


def table(columns):
    """A Markdown table of several checkouts' measures."""
    names = ["", *columns]
    rows = [names, ["---"] + ["---:"] * len(columns)]
    rows += [[row, *(str(measured.get(row, "")) for measured in columns.values())] for row in next(iter(columns.values()))]
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("roots", nargs="*", default=[f"today={Path(__file__).parent.parent}"], metavar="NAME=ROOT")
    parser.add_argument("--build", action="store_true", help="build each checkout from cold")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--walk", choices=JOURNEYS, help="print a journey instead")
    typed = parser.parse_args()
    # What has no name is called by its path.
    roots = {text.split("=")[0]: Path(text.split("=")[-1]) for text in typed.roots}
    if typed.walk:
        for name, behind_doors, walk in journeys(Workspace(next(iter(roots.values())))):
            if name == typed.walk and not behind_doors:
                for number, function in enumerate(walk.stays(), 1):
                    print(f"{number:3}  {function.source.path}  in by {function}")
        return
    columns = {name: measures(root, typed.build) for name, root in roots.items()}
    print(json.dumps(columns, indent=2) if typed.json else table(columns))


if __name__ == "__main__":
    main()
