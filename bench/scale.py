"""Measures tasks of Dask graphs on this machine, and works out from them what a survey of a terabyte takes: docs/scale.md.

    python bench/scale.py [SIDE]

It prints Markdown. What is measured says so; everything else follows from it by the model that is stated with it.
"""

import heapq
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

import dask
import distributed
import numpy as np
import petroglyph
import petroglyph.dask as stages

#: Network and disks of the modelled cluster, bytes a second of each worker to and from the shared store.
BANDWIDTH = 250e6
#: Samples down a trace of the modelled surveys.
SAMPLES = 1024
TIMES = []
#: Bytes that they read and wrote, in the same order.
MOVED = []


def moved():
    """Bytes that this process has read and written so far."""
    try:
        told = dict(line.split(": ") for line in Path("/proc/self/io").read_text().splitlines())
    except OSError:
        return 0
    return int(told["rchar"]) + int(told["wchar"])


def timed(name, call, *args):
    wall, cpu, before = time.perf_counter(), time.process_time(), moved()
    result = call(*args)
    TIMES.append((name, time.perf_counter() - wall, time.process_time() - cpu))
    MOVED.append(moved() - before)
    return result


def with_times(graph, wanted):
    """The graph with every task's time noted."""
    calls = {key: (timed, key[0].rsplit("-", 1)[0], *call) for key, call in graph.tasks.items()}
    with dask.config.set({"optimization.fuse.active": False}):
        return dask.local.get_sync(calls, wanted)


def nothing(n, *_):
    return n


def schedule(tasks, workers):
    """Seconds until all tasks are done, each taken by the first free worker once what it needs is done."""
    waiting = {key: len(needs) for key, (_, needs) in tasks.items()}
    after = {}
    for key, (_, needs) in tasks.items():
        for need in needs:
            after.setdefault(need, []).append(key)
    ready = [(0.0, key) for key, count in waiting.items() if count == 0]
    heapq.heapify(ready)
    free = [0.0] * workers
    heapq.heapify(free)
    end, latest = 0.0, {}
    while ready:
        at, key = heapq.heappop(ready)
        start = max(at, heapq.heappop(free))
        finish = start + tasks[key][0]
        heapq.heappush(free, finish)
        end = max(end, finish)
        for other in after.get(key, []):
            latest[other] = max(latest.get(other, 0.0), finish)
            waiting[other] -= 1
            if waiting[other] == 0:
                heapq.heappush(ready, (latest[other], other))
    return end


def modelled(lines, rates, kind, overhead):
    """Tasks of a survey of lines x lines traces: seconds, and what each needs."""
    edge = stages.FILE_LINES
    reach = petroglyph.bricks.halo(kind)
    columns = -(-lines // edge)
    brick = edge * edge * SAMPLES * 4
    pieces = stages._piece_lines(kind, SAMPLES, edge * edge, reach, stages.MEMORY)
    read = (edge // pieces) ** 2 * (pieces + 2 * reach) ** 2 * SAMPLES * 4
    seconds = rates[kind] * brick + (read + brick) / BANDWIDTH + overhead
    tasks = {("c", 0, x, y): (seconds, []) for x in range(columns) for y in range(columns)}
    level, samples, before = 1, SAMPLES, columns
    while before > 1 or samples > 64:
        now, samples = -(-before // 2), samples // 2
        own = edge * edge * max(samples, 1) * 4
        seconds = rates["halve"] * own + 9 * own / BANDWIDTH + overhead
        for x in range(now):
            for y in range(now):
                near = [(a, b) for a in range(2 * x - 1, 2 * x + 3) for b in range(2 * y - 1, 2 * y + 3)]
                needs = [("c", level - 1, a, b) for a, b in near if 0 <= a < before and 0 <= b < before]
                tasks["c", level, x, y] = (seconds, needs)
        level, before = level + 1, now
    return tasks


def candidates(folder, side):
    """Measures every task of an extraction from a synthetic survey.

    Returns the project, and for each stage its count of tasks and, per sample, seconds of the processor, bytes, and bytes
    of the whole survey that each of its tasks reads.
    """
    petroglyph.program.synth(folder / "synth", size=f"{side}x{side}x{side}", seed=3, snr="3")
    project = petroglyph.import_segy(folder / "synth" / "survey.sgy", folder / "synth.petro")
    for n in ("own", "two"):
        shutil.copytree(project.path, folder / f"{n}.petro")
    TIMES.clear()
    MOVED.clear()
    original = stages._run
    stages._run = lambda graph, wanted, *_: with_times(graph, wanted)
    try:
        done = stages.extract(project)
    finally:
        stages._run = original
    found = {}
    for (name, _, cpu), own in zip(TIMES, MOVED, strict=True):
        tasks, seconds, size = found.get(name, (0, 0.0, 0))
        found[name] = (tasks + 1, seconds + cpu, size + own)
    # Coarse dips of two kinds of extrema, in cells of 8 x 8 x 16 samples, and a row for each leaf.
    whole = {"dips": 2 * 8 / 1024, "distances": 16 * done["leaves"] / side**3}
    return {
        name: (tasks, cpu / side**3, size / side**3, whole.get(name, 0.0))
        for name, (tasks, cpu, size) in found.items()
        if name != "plan"
    }


def modelled_candidates(lines, measured, edge, overhead):
    """Tasks of an extraction of lines x lines traces in bricks of an edge, as they were measured: seconds, and what each needs.

    What one task does for the whole survey grows with the survey; other stages have a task for each brick or each column.
    """
    columns, bricks = -(-lines // stages.FILE_LINES), -(-lines // edge)
    samples = lines * lines * SAMPLES
    tasks, before = {}, []
    for name, (count, seconds, size, whole) in measured.items():
        if name.endswith("-end") and name.removesuffix("-end") in measured:
            tasks[name] = (overhead + seconds * samples, before)
            before = [name]
            continue
        level = int(name.removeprefix("store-level-")) if name.startswith("store-level-") else 0
        is_single = count == 1 and not level and name != "trees"
        is_by_column = name in ("trees", "distances") or name.startswith("store-")
        many = 1 if is_single else max((columns if is_by_column else bricks) ** 2 // 4**level, 1)
        each = (seconds + size / BANDWIDTH) * samples / many + whole * samples / BANDWIDTH + overhead
        own = [(name, n) for n in range(many)]
        tasks.update({key: (each, before) for key in own})
        before = own
    return tasks


def main():
    side = int(sys.argv[1]) if len(sys.argv) > 1 else 256
    geometry = petroglyph.Geometry.regular((side, side, side))
    random = np.random.default_rng(1)
    folder = Path(tempfile.mkdtemp(prefix="scale-"))
    print(f"Survey of {side}³ floats ({side**3 * 4 / 1e6:.0f} MB), {os.cpu_count()} processors.\n")

    def block(x):
        at = np.arange(side, dtype=np.float32)
        return np.sin(0.4 * (at[None, None, :] + 0.1 * x + 0.05 * at[None, :, None])) + 0.1 * random.standard_normal(
            (1, side, side)
        )

    samples = np.concatenate([block(x) for x in range(side)]).astype(np.float32)
    project = petroglyph.import_volume(samples, folder / "scale.petro", geometry=geometry)
    del samples
    rates = {}
    print("| stage | tasks | seconds of one thread | bytes read | bytes written | seconds per GB of input |")
    print("|---|---|---|---|---|---|")
    original = stages._run
    for kind in ("envelope", "semblance", "dip"):
        TIMES.clear()
        stages._run = lambda graph, wanted, *_: with_times(graph, wanted)
        stages.attribute(project, kind, f"timed-{kind}")
        stages._run = original
        plan = stages.plan(project.volume().path, kind)
        gigabytes = side**3 * 4 / 1e9
        cpu = sum(cpu for _, _, cpu in TIMES)
        wall = sum(wall for _, wall, _ in TIMES)
        print(
            f"| {kind} | {sum(plan.tasks.values())} | {wall:.1f} | {plan.bytes_read / 1e6:.0f} MB | "
            f"{plan.bytes_written / 1e6:.0f} MB | {wall / gigabytes:.0f} |"
        )
        columns = [wall for name, wall, _ in TIMES if name == kind]
        rates[kind] = sum(columns) / (side**3 * 4)
        halves = [wall for name, wall, _ in TIMES if name.startswith("halve-1")]
        rates["halve"] = max(halves and sum(halves) / len(halves) / ((side // 2) ** 3 * 4) or 0.0, 1e-12)
        assert cpu <= wall * 1.5

    measured = candidates(folder, side)
    cpu, size = (sum(row[n] for row in measured.values()) * side**3 for n in (1, 2))
    print(
        f"| candidates | {sum(row[0] for row in measured.values())} | {cpu:.1f} | {size / 1e6:.0f} MB in all | | "
        f"{cpu / (side**3 * 4 / 1e9):.0f} |"
    )

    with distributed.LocalCluster(2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            count = 2000
            client.get({("warm", 0): (nothing, 0)}, [("warm", 0)])
            began = time.perf_counter()
            client.get({("n", n): (nothing, n) for n in range(count)}, [("n", n) for n in range(count)])
            overhead = (time.perf_counter() - began) / count
            began = time.perf_counter()
            project.attribute("semblance", "own", memory=2 << 30)
            own = time.perf_counter() - began
            began = time.perf_counter()
            stages.attribute(project, "semblance", "two", scheduler=client)
            two = time.perf_counter() - began
            began = time.perf_counter()
            petroglyph.open(folder / "own.petro").extract(memory=1 << 40)
            own_extract = time.perf_counter() - began
            began = time.perf_counter()
            stages.extract(petroglyph.open(folder / "two.petro"), scheduler=client)
            two_extract = time.perf_counter() - began
    print(f"\nOverhead of a task: {overhead * 1e3:.2f} ms (measured on {count} empty ones, two workers).")
    print(f"Semblance: {own:.1f} s by the program's own threads, {two:.1f} s by two workers ({two / own:.2f}).")
    print(
        f"Candidates: {own_extract:.1f} s by the program's own threads in one piece, {two_extract:.1f} s by two workers "
        f"({two_extract / own_extract:.2f}).\n"
    )

    print("| modelled survey | workers | tasks | hours | efficiency | worker hours |")
    print("|---|---|---|---|---|---|")
    terabyte = int((1e12 / 4 / SAMPLES) ** 0.5)
    for kind in ("envelope", "semblance", "candidates"):
        for lines, workers in ((2048, 16), (terabyte, 64)):
            if kind == "candidates":
                edge = stages._brick_edge((side, side, side), os.cpu_count() or 1)
                tasks = modelled_candidates(lines, measured, edge, overhead)
            else:
                tasks = modelled(lines, rates, kind, overhead)
            total = sum(seconds for seconds, _ in tasks.values())
            # The scheduler hands out one task after the other.
            end = max(schedule(tasks, workers), len(tasks) * overhead)
            print(
                f"| {kind}, {lines} x {lines} x {SAMPLES} | {workers} | {len(tasks)} | {end / 3600:.2f} | "
                f"{total / workers / end:.0%} | {total / 3600:.1f} |"
            )


if __name__ == "__main__":
    main()
