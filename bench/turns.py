#!/usr/bin/env python3
"""Compares two builds of the program: each task is run by both in turns, so that whatever else the machine does meets both alike.

    python3 bench/turns.py OLD NEW [--repeats 9] [--processor] [--demo out/demo/demo.petro] [--task NAME …]

OLD and NEW are programs (target/debug/petroglyph). The project of `make demo` is copied for each of them, opened once by its own program
and never shared. With PETROGLYPH_DATA, the folder of the data files, a part of F3 is imported and its candidates extracted, too. Printed for
each task: the median seconds of both, their ratio (new : old), the quartiles of the ratios of neighbouring runs, and the most memory of
both. A task that changes a project is undone, unmeasured, before the next run. Only Python's standard library is needed, on Unix."""
import argparse
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

F3 = "volumes/f3_depth_il300-427_xl720-975_int16.sgy"
PICTURE = ["--size", "800x600", "--device", "cpu"]
# Of each project: the task's name, what is typed (`{project}`, `{out}`), and what puts the project back.
UNDO = ["undo", "{project}"]
DEMO = {
    "demo: info": (["info", "{project}", "--json"], None),
    "demo: render": (["render", "{project}", "{out}.png", "--cut", "nearest,0.45,0.45", *PICTURE], None),
    "demo: page": (["render", "{project}", "{out}.png", "--block", "--inline", "130", "--crossline", "560", "--legend", *PICTURE], None),
    "demo: pick": (["pick", "{project}", "--at", "190,566,528.6", "--horizon", "Clicked", "--highest-valid"], UNDO),
    "demo: undo": (UNDO, ["redo", "{project}"]),
}
FIRST = ["pick", "{project}", "--at", "364,860,1236", "--horizon", "First", "--highest-valid"]
FIELD = {
    "F3: info": (["info", "{project}", "--json"], None),
    "F3: render": (["render", "{project}", "{out}.png", "--cut", "nearest,0.5,0.4", "--blend", "1", *PICTURE], None),
    "F3: section": (["render", "{project}", "{out}.png", "--inline", "364", *PICTURE], None),
    "F3: pick": (["pick", "{project}", "--at", "375,849,1304", "--horizon", "Clicked", "--highest-valid"], UNDO),
    "F3: undo": (UNDO, ["redo", "{project}"]),
}


class Build:
    """One of the two programs, with projects of its own."""

    def __init__(self, program, folder, is_processor):
        self.program, self.folder, self.is_processor = Path(program).resolve(), folder, is_processor
        folder.mkdir()
        # What is noted of projects stays apart, too.
        self.environment = {**os.environ, "XDG_STATE_HOME": str(folder / "state")}

    def run(self, arguments, project):
        """Runs the program; returns its seconds and its most memory in MB."""
        words = [word.format(project=self.folder / project, out=self.folder / "picture") for word in arguments]
        start = time.perf_counter()
        process = subprocess.Popen(
            [self.program, *words], env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
        )
        said = process.stderr.read().decode(errors="replace")
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        seconds = usage.ru_utime + usage.ru_stime if self.is_processor else time.perf_counter() - start
        if process.returncode != 0:
            sys.exit(f"{self.program} {' '.join(words)} failed:\n{said}")
        # Kilobytes on Linux, bytes on macOS.
        return seconds, usage.ru_maxrss / (1024 if sys.platform != "darwin" else 1024**2)


def compare(builds, name, project, task, back, repeats):
    """Runs a task in turns and prints its line."""
    seconds, memory = ([], []), ([], [])
    for turn in range(repeats + 1):
        # The first runs fill caches; who begins changes with every turn.
        for which in (0, 1) if turn % 2 else (1, 0):
            taken, most = builds[which].run(task, project)
            if back:
                builds[which].run(back, project)
            if turn > 0:
                seconds[which].append(taken)
                memory[which].append(most)
    ratios = [new / old for old, new in zip(*seconds)]
    low, _, high = statistics.quantiles(ratios, n=4)
    old, new = map(statistics.median, seconds)
    print(
        f"| {name} | {old:.3f} | {new:.3f} | {statistics.median(ratios):.3f} | {low:.3f} to {high:.3f} "
        f"| {max(memory[0]):.0f} | {max(memory[1]):.0f} |",
        flush=True,
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--demo", type=Path, default=Path("out/demo/demo.petro"))
    parser.add_argument("--task", action="append", help="only tasks whose name has this in it")
    parser.add_argument("--processor", action="store_true", help="seconds of all processors, which other programs disturb less")
    typed = parser.parse_args()
    is_wanted = lambda name: not typed.task or any(part in name for part in typed.task)
    data = os.environ.get("PETROGLYPH_DATA")
    with tempfile.TemporaryDirectory() as folder:
        named = (("old", typed.old), ("new", typed.new))
        builds = [Build(program, Path(folder, name), typed.processor) for name, program in named]
        tasks = {"demo.petro": {name: task for name, task in DEMO.items() if is_wanted(name)}}
        if data:
            tasks["f3.petro"] = {name: task for name, task in FIELD.items() if is_wanted(name)}
        print("| task | old, s | new, s | ratio | its quartiles | old, MB | new, MB |\n|---|---:|---:|---:|---|---:|---:|")
        for project, wanted in tasks.items():
            if not wanted:
                continue
            for build in builds:
                if project == "demo.petro":
                    shutil.copytree(typed.demo, build.folder / project)
                else:
                    build.run(["import", str(Path(data, F3)), "{project}"], project)
                    build.run(["extract", "{project}"], project)
                    build.run(FIRST, project)
            for name, (task, back) in wanted.items():
                compare(builds, name, project, task, back, typed.repeats)


if __name__ == "__main__":
    main()
