"""Stages as Dask graphs over stored volumes, on any scheduler.

A task is a pure function of named arrays in the store: it reads a brick with its halo, computes on one thread and writes
whole files, each of which has its name only when it is complete. Nothing is kept from one task to the next. So a task may
run anywhere, twice, or again after its worker was lost: the bytes are the same, and they are those of the program itself.

Stages whose result depends on the whole survey hand short summaries of each brick to a task that merges them.

Every function takes ``scheduler``, as of :func:`dask.compute` (``"threads"``, ``"processes"``, ``"synchronous"``), or a
:class:`distributed.Client`; the names of tasks in the dashboard are those of the stages.
"""

from __future__ import annotations

import contextlib
import json
import math
import os
import socket
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from petroglyph import STORE_VERSION, __version__, _native, bricks
from petroglyph._errors import PetroglyphError
from petroglyph._folders import beside, written
from petroglyph._geometry import Geometry
from petroglyph._types import Options, Path
from petroglyph.bricks import _json

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from petroglyph._project import Project

#: A scheduler by its name, or a client of a cluster.
Scheduler = Any
Kind = Literal["envelope", "semblance", "fault-likelihood", "throw", "dip"]
Three = tuple[int, int, int]
#: What a task tells of the files that it wrote: numbers of bricks and their least and greatest samples.
Ranges = tuple["npt.NDArray[np.uint64]", "npt.NDArray[np.float32]"]

#: Lines of a file of a stored volume along both axes.
FILE_LINES = 128
#: Memory that a task may use unless another is stated, bytes.
MEMORY = 1 << 30
#: Memory that a worker needs before any task: Python, NumPy and the libraries.
WORKER_BYTES = 200 << 20
#: How often a task is tried again.
RETRIES = 3
#: Samples that a filtered level reaches beyond its own, in samples of the finer one.
_FILTER_REACH = 3


@dataclass(frozen=True)
class Plan:
    """What a run will do, before anything is computed.

    Attributes
    ----------
    tasks : dict of str to int
        Number of tasks by stage.
    bytes_read, bytes_written : int
        Bytes that all tasks read from the store and write to it, halos included.
    task_bytes : int
        The most memory that one task uses beside :data:`WORKER_BYTES`.
    """

    tasks: dict[str, int]
    bytes_read: int
    bytes_written: int
    task_bytes: int


# What runs on workers. All arguments are small; all data are in the store.


def _version() -> tuple[str, int]:
    return __version__, STORE_VERSION


def _same_version(client: tuple[str, int]) -> None:
    here = _version()
    if client != here:
        raise PetroglyphError(
            f"the worker on {socket.gethostname()} has petroglyph {here[0]} with store version {here[1]}, the client "
            f"{client[0]} with {client[1]}",
            "install the same version on all workers and on the client",
        )


def _at_hand(path: str) -> str:
    if not os.path.isdir(path):
        raise PetroglyphError(
            f"{path} is not there on the worker on {socket.gethostname()}",
            "put the project on a disk that all workers see under the same path",
        )
    return path


def _cut(start: int, count: int, reach: int, total: int) -> tuple[int, int, int]:
    """First line and count of a range with its halo, and the halo before it."""
    first = max(start - reach, 0)
    return first, min(start + count + reach, total) - first, start - first


def _piece_lines(kind: str, samples: int, own: int, reach: int, memory: int) -> int:
    """Lines along both axes of the pieces in which a task computes, so that it keeps within its memory."""
    lines = FILE_LINES
    while lines > 16 and _task_bytes(kind, samples, own, reach, lines) > memory:
        lines //= 2
    return lines


def _task_bytes(kind: str, samples: int, own: int, reach: int, lines: int) -> int:
    """Memory of a task: its files as a whole and one of them as it is written, and a piece with its halo."""
    files = own * samples * 4 * (2 if kind == "dip" else 1)
    file = FILE_LINES**3 * 4 * 2
    return files + file + (lines + 2 * reach) ** 2 * samples * bricks.BYTES_HELD[kind]


@dataclass(frozen=True)
class _Stage:
    """What tasks of one stage have in common; small, and sent to workers."""

    kind: str
    source: str
    targets: tuple[str, ...]
    size: Three
    lines: int
    dip: str | None
    semblance: str | None
    geometry: str
    version: tuple[str, int]


def _compute(stage: _Stage, inputs: list[npt.NDArray[Any]], live: Any) -> list[npt.NDArray[Any]]:
    if stage.kind == "envelope":
        return [_native.envelope(inputs[0], live)]
    if stage.kind == "semblance":
        return [_native.semblance(inputs[0], live, stage.dip, stage.semblance)]
    if stage.kind == "fault-likelihood":
        return [_native.fault_likelihood(inputs[0], stage.geometry, live)]
    if stage.kind == "throw":
        return [_native.throw(inputs[0], stage.geometry, live)]
    if stage.kind == "dip":
        return _native.dip(inputs[0], live, stage.dip)
    return [_native.dip_angle(inputs[0], inputs[1], stage.geometry, live)]


def _column(
    stage: _Stage, sources: tuple[str, ...], start: tuple[int, int], count: tuple[int, int], *_: Any
) -> list[Ranges]:
    """Computes a column of files, in pieces, and writes them; further arguments are what must be done before."""
    import numpy as np

    _same_version(stage.version)
    for path in (*sources, *stage.targets):
        _at_hand(path)
    nx, ny, nz = stage.size
    reach = _native.reach(stage.kind, stage.dip, stage.semblance, stage.geometry)
    live = _native.read_live(sources[0])
    results = [np.empty((*count, nz), dtype=np.float32) for _ in stage.targets]
    for x in range(0, count[0], stage.lines):
        for y in range(0, count[1], stage.lines):
            own = (min(stage.lines, count[0] - x), min(stage.lines, count[1] - y))
            x0, width, left = _cut(start[0] + x, own[0], reach, nx)
            y0, depth, front = _cut(start[1] + y, own[1], reach, ny)
            read = [_native.read_box(path, 0, (x0, y0, 0), (width, depth, nz)) for path in sources]
            read = [np.ascontiguousarray(samples, dtype=np.float32) for samples in read]
            mask = np.ascontiguousarray(live[x0 : x0 + width, y0 : y0 + depth])
            found = _compute(stage, read, None if mask.all() else mask)
            del read
            inner = (slice(left, left + own[0]), slice(front, front + own[1]))
            for result, values in zip(results, found, strict=True):
                result[x : x + own[0], y : y + own[1]] = values[inner]
            del found
    return [_write(path, result, start) for path, result in zip(stage.targets, results, strict=True)]


def _write(path: str, values: npt.NDArray[Any], start: tuple[int, int]) -> Ranges:
    """Writes the files of a column of traces."""
    import numpy as np

    parts = _native.VolumeParts.open(path)
    x0, y0 = start
    found: list[tuple[int, tuple[float, float]]] = []
    for place, first, part in parts.files(0):
        if first[0] < x0 or first[1] < y0 or first[0] >= x0 + values.shape[0] or first[1] >= y0 + values.shape[1]:
            continue
        x, y, z = first[0] - x0, first[1] - y0, first[2]
        box = values[x : x + part[0], y : y + part[1], z : z + part[2]]
        found += parts.write((place[0], place[1], place[2]), np.ascontiguousarray(box))
    return _packed(found)


def _packed(found: Iterable[tuple[int, tuple[float, float]]]) -> Ranges:
    import numpy as np

    found = list(found)
    numbers = np.array([brick for brick, _ in found], dtype=np.uint64)
    return numbers, np.array([ends for _, ends in found], dtype=np.float32).reshape(-1, 2)


def _halve(path: str, level: int, places: list[Three], version: tuple[str, int], *_: Any) -> Ranges:
    """Makes files of a further level of the pyramid; the other arguments are what must be done before."""
    _same_version(version)
    parts = _native.VolumeParts.open(_at_hand(path))
    return _packed(ranges for place in places for ranges in parts.halve(level, place))


def _part(ranges: list[Ranges], n: int) -> Ranges:
    return ranges[n]


def _merge(found: list[Ranges]) -> Ranges:
    import numpy as np

    return np.concatenate([one[0] for one in found]), np.concatenate([one[1] for one in found])


def _finish(path: str, levels: list[Ranges], version: tuple[str, int]) -> str:
    _same_version(version)
    unpacked = [list(zip(bricks.tolist(), ends.tolist(), strict=True)) for bricks, ends in levels]
    _native.VolumeParts.open(_at_hand(path)).finish(unpacked)
    return path


# Graphs.


class _Graph:
    """A graph under construction: names of tasks, what they do and how many of each stage there are."""

    def __init__(self, token: str) -> None:
        self.token = token
        self.tasks: dict[Any, Any] = {}
        self.counts: dict[str, int] = {}

    def add(self, stage: str, place: tuple[int, ...], call: tuple[Any, ...]) -> tuple[Any, ...]:
        key = (f"{stage}-{self.token}", *place)
        self.tasks[key] = call
        self.counts[stage] = self.counts.get(stage, 0) + 1
        return key

    def pyramid(self, path: str, parts: _native.VolumeParts, columns: dict[tuple[int, int], Any], label: str) -> Any:
        """The further levels of a volume whose level 0 is written by `columns`, and its completion."""
        version = _version()
        before: dict[tuple[int, int], Any] = columns
        levels = [self.add(f"merge{label}", (0,), (_merge, list(columns.values())))]
        for level in range(1, parts.level_count()):
            files: dict[tuple[int, int], list[Three]] = {}
            spans: dict[tuple[int, int], tuple[list[int], list[int]]] = {}
            for place, first, part in parts.files(level):
                files.setdefault((place[0], place[1]), []).append((place[0], place[1], place[2]))
                spans[place[0], place[1]] = (first, part)
            made = {}
            for column, places in files.items():
                first, part = spans[column]
                needed = [
                    key
                    for at, key in before.items()
                    if all(
                        at[axis] * FILE_LINES <= 2 * (first[axis] + part[axis] - 1) + _FILTER_REACH
                        and (at[axis] + 1) * FILE_LINES > 2 * first[axis] - _FILTER_REACH
                        for axis in (0, 1)
                    )
                ]
                made[column] = self.add(
                    f"halve{label}-{level}", column, (_halve, path, level, places, version, *needed)
                )
            levels.append(self.add(f"merge{label}", (level,), (_merge, list(made.values()))))
            before = made
        return self.add(f"finish{label}", (), (_finish, path, levels, version))


def _is_client(scheduler: Scheduler) -> bool:
    return hasattr(scheduler, "get") and hasattr(scheduler, "scheduler_info")


def _run(graph: _Graph, wanted: list[Any], scheduler: Scheduler, retries: int) -> list[Any]:
    """Runs a graph on a cluster's client or on a scheduler of this process."""
    import dask
    from dask.base import get_scheduler

    if _is_client(scheduler):
        return list(scheduler.get(graph.tasks, wanted, retries=retries))
    get = get_scheduler(scheduler=scheduler or "threads")
    with dask.config.set({"optimization.fuse.active": False}):
        return list(get(graph.tasks, wanted))


def plan(source: Path, kind: Kind, *, memory: int = MEMORY, **settings: Options | None) -> Plan:
    """What :func:`attribute` of a stored volume will do.

    Parameters
    ----------
    source : path
        Folder of the volume.
    kind : {"envelope", "semblance", "fault-likelihood", "throw", "dip"}
        The attribute.
    memory : int
        Memory that a task may use, bytes.
    **settings
        ``dip`` and ``semblance``.
    """
    import numpy as np

    found = json.loads(_native.volume_info(source))
    nx, ny, nz = found["levels"][0]
    reach = _native.reach(kind, _json(settings.get("dip")), _json(settings.get("semblance")), json.dumps(found["geometry"]))
    own = min(FILE_LINES, nx) * min(FILE_LINES, ny)
    lines = _piece_lines(kind, nz, own, reach, memory)
    sample = np.dtype(found["dtype"]).itemsize
    columns = _columns(nx, ny)
    read = 0
    for _, (x, y), (width, depth) in columns:
        across = [_cut(x + at, min(lines, width - at), reach, nx)[1] for at in range(0, width, lines)]
        along = [_cut(y + at, min(lines, depth - at), reach, ny)[1] for at in range(0, depth, lines)]
        read += sum(across) * sum(along) * nz * sample
    tasks: dict[str, int] = {kind: len(columns)}
    volumes = 3 if kind == "dip" else 1
    written = nx * ny * nz * 4 * volumes
    if kind == "dip":
        tasks["dip-angle"] = len(columns)
        read += 2 * nx * ny * nz * 4
    levels = [tuple(size) for size in found["levels"]]
    for level, size in enumerate(levels[1:], 1):
        across = [-(-n // FILE_LINES) for n in size[:2]]
        tasks[f"halve-{level}"] = across[0] * across[1] * volumes
        finer = levels[level - 1]
        read += finer[0] * finer[1] * finer[2] * 4 * volumes
        written += size[0] * size[1] * size[2] * 4 * volumes
    return Plan(tasks, read, written, _task_bytes(kind, nz, own, reach, lines))


def attribute(
    project: Project,
    kind: Kind,
    name: str,
    *,
    volume: str | None = None,
    dip: Options | None = None,
    semblance: Options | None = None,
    scheduler: Scheduler = None,
    memory: int = MEMORY,
    retries: int = RETRIES,
) -> dict[str, Any]:
    """Computes an attribute of a volume on a cluster and adds it to the project.

    Parameters
    ----------
    project : Project
        The project, on a disk that all workers see.
    kind : {"envelope", "semblance", "fault-likelihood", "throw", "dip"}
        What to compute.
    name : str
        Name of the new volume; a dip adds ``NAME-inline`` and ``NAME-crossline``.
    volume : str, optional
        The volume it is computed from; by default the first.
    dip, semblance : mapping, optional
        Settings, as of :meth:`petroglyph.Project.attribute`.
    scheduler : str or distributed.Client, optional
        Where it runs; by default on threads of this process.
    memory : int
        Memory that a task may use, bytes; see :func:`plan`.
    retries : int
        How often a task that failed is tried again on a cluster.

    Returns
    -------
    dict
        What was done, by name of the new volume.

    Notes
    -----
    The bytes of the new volumes are those of :meth:`petroglyph.Project.attribute`. If a task fails for good, nothing is
    added, and what was written is removed.
    """
    source = volume or (project.volumes or [""])[0]
    read = project.volume(source)
    geometry = {**read.info["geometry"], "velocity_m_s": project.geometry.velocity_m_s}
    live = read.live()
    named: dict[str, tuple[str, str | None]] = {name: (kind, "samples" if kind == "throw" else None)}
    if kind == "dip":
        named = {
            f"{name}-inline": ("dip inline", "samples per inline"),
            f"{name}-crossline": ("dip crossline", "samples per crossline"),
            name: ("dip", "degrees"),
        }
    with beside(project.path) as folder:
        folders = {new: os.path.join(folder, f"{n}.zarr") for n, new in enumerate(named)}
        for new, (quantity, unit) in named.items():
            info = {"geometry": geometry, "quantity": quantity, "unit": unit, "source": f"{kind} of {source}"}
            _native.VolumeParts.create(folders[new], json.dumps(info), "float32", None if live.all() else live)
        settings = (_json(dip), _json(semblance), json.dumps(geometry), _version())
        path, targets = os.path.abspath(read.path), tuple(folders.values())
        graph, wanted = _attribute_graph(path, targets, kind, read.shape, settings, memory)
        _run(graph, wanted, scheduler, retries)
        first = sorted(named, key=lambda new: new != name)
        origin = {"kind": "attribute", "attribute": kind, "of": source}
        imports = {new: {"path": folders[new], "name": new, "origin": origin} for new in first}
        return {new: project.apply({"import": stored}, _moved=True) for new, stored in imports.items()}


def _attribute_graph(
    path: str,
    targets: tuple[str, ...],
    kind: str,
    size: Three,
    settings: tuple[str | None, str | None, str, tuple[str, int]],
    memory: int,
) -> tuple[_Graph, list[Any]]:
    nx, ny, nz = size
    own = min(FILE_LINES, nx) * min(FILE_LINES, ny)
    columns = _columns(nx, ny)
    graph = _Graph(_token(path, targets, kind, settings, memory))

    def computed(kind: str, targets: tuple[str, ...], sources: tuple[str, ...], *before: Any) -> list[Any]:
        """Tasks that compute volumes, and those that complete them."""
        lines = _piece_lines(kind, nz, own, _native.reach(kind, *settings[:3]), memory)
        stage = _Stage(kind, path, targets, size, lines, *settings)
        tasks = {at: graph.add(kind, at, (_column, stage, sources, start, count, *before)) for at, start, count in columns}
        completed = []
        for n, target in enumerate(targets):
            label = f"-{n}" if len(targets) > 1 else "-angle" if before else ""
            ranges = {at: graph.add(f"ranges{label}", at, (_part, key, n)) for at, key in tasks.items()}
            completed.append(graph.pyramid(target, _native.VolumeParts.open(target), ranges, label))
        return completed

    if kind != "dip":
        return graph, computed(kind, targets, (path,))
    wanted = computed(kind, targets[:2], (path,))
    # Complete volumes alone can be read.
    return graph, [*wanted, *computed("dip-angle", targets[2:], targets[:2], *wanted)]


# Horizon candidates.


def _candidates_task(plan: str, stage: str, slot: int, slots: int, version: tuple[str, int], *_: Any) -> None:
    """Does the tasks of a stage that fall to a slot: one, where there are as many slots as tasks."""
    tasks = _candidates(plan, version)
    for number in range(slot, tasks.count(stage), slots):
        tasks.run(stage, number)


def _candidates_end(plan: str, stage: str, version: tuple[str, int], *_: Any) -> None:
    """Notes that a stage is done; the other arguments are its tasks."""
    _candidates(plan, version).close(stage)


def _candidates(plan: str, version: tuple[str, int]) -> _native.ExtractionTasks:
    _same_version(version)
    told = json.loads(plan)
    for folder in (told["volume"], told["arrays"]):
        _at_hand(folder)
    return _native.ExtractionTasks(plan)


def _candidates_graph(plan: str, told: Any = None) -> tuple[_Graph, list[Any]]:
    """Stages one after the other; of each, one task for each brick, column, file or slot. `told` stands for the plan."""
    version = _version()
    stages = _native.ExtractionTasks(plan).stages()
    graph = _Graph(_token(plan))
    told = plan if told is None else told
    slots = _slots(stages)
    before: Any = None
    for stage, count in stages:
        many = slots if count is None else count
        tasks = [graph.add(stage, (n,), (_candidates_task, told, stage, n, many, version, before)) for n in range(many)]
        before = graph.add(f"{stage}-end", (), (_candidates_end, told, stage, version, tasks))
    return graph, [before]


def _everywhere(scheduler: Scheduler, value: str) -> Any:
    """A value on every worker of a cluster: a scheduler gives a task to a worker that has what the task needs, and would
    give all tasks of a stage to one."""
    if not _is_client(scheduler):
        return value
    future = scheduler.submit(str, value, pure=False)
    scheduler.replicate([future])
    return future


def _threads(scheduler: Scheduler) -> int:
    """Tasks that are done at a time."""
    return (sum(scheduler.nthreads().values()) if _is_client(scheduler) else os.cpu_count()) or 1


def _brick_edge(shape: tuple[int, int, int], threads: int) -> int:
    """Traces of a brick so that there are two for every thread: larger ones read less of what lies around them."""
    return max(FILE_LINES, math.isqrt(shape[0] * shape[1] // (2 * threads)))


def _slots(stages: list[tuple[str, int | None]]) -> int:
    """Tasks of stages whose count depends on what is found: as many as others have."""
    return max(count or 1 for _, count in stages)


def plan_extraction(
    source: Path, *, settings: Options | None = None, edge: int | None = None, memory: int = MEMORY
) -> Plan:
    """What :func:`extract` of a stored volume will do.

    Parameters
    ----------
    source : path
        Folder of the volume.
    settings, edge, memory
        As of :func:`extract`, on threads of this process.

    Notes
    -----
    Bytes are those of the volume and of the candidates with ids of two bytes. What stages hand to one another through the
    project's folder is not known beforehand.
    """
    import numpy as np

    found = json.loads(_native.volume_info(source))
    levels: list[tuple[int, int, int]] = [tuple(size) for size in found["levels"]]
    if edge is None:
        edge = _brick_edge(levels[0], os.cpu_count() or 1)
    _, stages = _native.extraction_stages(source, _json(settings), memory, edge)
    slots = _slots(stages)
    tasks = {stage: slots if count is None else count for stage, count in stages}
    voxels = [size[0] * size[1] * size[2] for size in levels]
    nx, ny, nz = levels[0]
    # A column as it is found, and one of its files while it is written.
    column = min(nx, FILE_LINES) * min(ny, FILE_LINES) * nz * 5 + FILE_LINES**3 * 4 * 2
    read = voxels[0] * np.dtype(found["dtype"]).itemsize
    return Plan(tasks, read, sum(voxels) * 3, max(memory, column))


def extract(
    project: Project,
    *,
    volume: str | None = None,
    settings: Options | None = None,
    edge: int | None = None,
    scheduler: Scheduler = None,
    memory: int = MEMORY,
    retries: int = RETRIES,
) -> dict[str, Any]:
    """Finds horizon candidates on a cluster: surfaces, their trees, and the closest leaf of every voxel.

    Parameters
    ----------
    project : Project
        The project, on a disk that all workers see.
    volume : str, optional
        The volume to extract from; by default the first on the project's lattice.
    settings : mapping, optional
        Settings, as of :meth:`petroglyph.Project.extract`.
    edge : int, optional
        Traces of a brick along both axes, at most; fewer where `memory` asks for it. Smaller bricks are more tasks, and
        read more of what lies around them. By default there are two bricks for each thread of the cluster, but none is
        smaller than a file of 128 x 128 traces.
    scheduler : str or distributed.Client, optional
        Where it runs; by default on threads of this process.
    memory : int
        Memory that a task may use, bytes; see :func:`plan_extraction`.
    retries : int
        How often a task that failed is tried again on a cluster.

    Returns
    -------
    dict
        What was done, as of :meth:`petroglyph.Project.extract`.

    Notes
    -----
    The bytes are those of :meth:`petroglyph.Project.extract`, whatever the bricks and the workers. Stages exchange what
    they find through files in the project. If a task fails for good they are removed, and the project is what it was. If
    the run was interrupted, or the cluster was lost, the same call goes on where it was, in the same bricks, also on a
    cluster of another size; with another `memory` it begins anew.
    """
    if edge is None:
        edge = _brick_edge(project.geometry.shape, _threads(scheduler))
    change = {"volume": volume, "settings": None if settings is None else dict(settings)}
    command = {"extract": {name: value for name, value in change.items() if value is not None}}
    shared = _native.Extraction.begin(project._native, volume, _json(settings), memory, edge)
    if shared is None:
        return project.apply(command)
    try:
        plan = shared.plan()
        graph, wanted = _candidates_graph(plan, _everywhere(scheduler, plan))
        _run(graph, wanted, scheduler, retries)
    except PetroglyphError:
        shared.end(leave=False)
        raise
    except BaseException:
        shared.end(leave=True)
        raise
    shared.publish()
    return project.apply(command, _moved=True)


# Geologic time.


def _keep(folder: str, name: str, values: npt.NDArray[Any]) -> None:
    """Writes a named array, which is whole or not there."""
    import zarr

    chunks = tuple(max(min(edge, count), 1) for edge, count in zip((FILE_LINES,) * 2 + (1 << 20,), values.shape, strict=True))
    # A task that ran twice has written the same.
    with contextlib.suppress(PetroglyphError), written(os.path.join(folder, name)) as partial:
        zarr.create_array(partial, shape=values.shape, chunks=chunks, dtype=values.dtype)[...] = values


def _kept(folder: str, name: str) -> Any:
    import zarr

    return zarr.open_array(os.path.join(_at_hand(folder), name), mode="r")


def _time_slab(path: str, arrays: str, slab: int, memory: int, settings: str, version: tuple[str, int]) -> int:
    from petroglyph import open as open_project

    _same_version(version)
    tau, found = _native.time_slab(open_project(_at_hand(path))._native, memory, settings, slab)
    _keep(_at_hand(arrays), f"slab-{slab}", tau)
    return found


def _time_join(arrays: str, slab: int, is_last: bool, *_: Any) -> int:
    """Sets the clock of a slab by the one before it; the other arguments are what must be done before."""
    import numpy as np

    common = _kept(arrays, f"common-{slab - 1}")[...] if slab else None
    lines, common = _native.join_times(common, _kept(arrays, f"slab-{slab}")[...], is_last)
    _keep(arrays, f"lines-{slab}", lines)
    if not is_last:
        _keep(arrays, f"common-{slab}", common)
    return int(np.isfinite(lines).sum())


def _time_column(
    arrays: str, target: str, starts: list[int], start: tuple[int, int], count: tuple[int, int], *_: Any
) -> Ranges:
    """Writes a column of files from the lines of all slabs that it reaches into."""
    import numpy as np

    parts = []
    for slab, first in enumerate(starts):
        lines = _kept(arrays, f"lines-{slab}")
        own = slice(max(start[0] - first, 0), max(min(start[0] + count[0] - first, lines.shape[0]), 0))
        if own.start < own.stop:
            parts.append(lines[own, start[1] : start[1] + count[1]])
    return _write(_at_hand(target), np.concatenate(parts), start)


def time(
    project: Project,
    name: str = "time",
    *,
    settings: Options | None = None,
    scheduler: Scheduler = None,
    memory: int = MEMORY,
    retries: int = RETRIES,
) -> dict[str, Any]:
    """Computes geologic time on a cluster and adds it to the project: slabs of inlines side by side, then joined.

    Parameters
    ----------
    project : Project
        The project with horizon candidates, on a disk that all workers see.
    name : str
        Name of the new volume.
    settings : mapping, optional
        Settings, as of :meth:`petroglyph.Project.time`.
    scheduler : str or distributed.Client, optional
        Where it runs; by default on threads of this process.
    memory : int
        Memory that solving a slab may use beside the candidates, bytes. It sets the width of the slabs, of 96 inlines at
        least, and they the result, by a part of a sample.
    retries : int
        How often a task that failed is tried again on a cluster.

    Returns
    -------
    dict
        What was done, with the number of ``slabs``, of faults that were ``found`` where none is drawn, and the share of the
        samples at which time is ``known``.

    Notes
    -----
    The bytes are those of :meth:`petroglyph.Project.time` with the same memory. Slabs are solved independently; joining them
    goes from one to the next and takes little. If a task fails for good, nothing is added, and what was written is removed.
    """
    options = json.dumps(dict(settings or {}))
    source, info, ranges = _native.time_slabs(project._native, memory, options)
    path = os.path.abspath(project.path)
    nx, ny, nz = project.volume(source).shape
    with beside(path) as folder:
        target, arrays = os.path.join(folder, "time.zarr"), os.path.join(folder, "slabs")
        os.mkdir(arrays)
        parts = _native.VolumeParts.create(target, info, "float32", None)
        graph, version = _Graph(_token(path, target, memory, options)), _version()
        solved: list[Any] = []
        joined: list[Any] = []
        for n in range(len(ranges)):
            solved.append(graph.add("time-slab", (n,), (_time_slab, path, arrays, n, memory, options, version)))
            before = joined[-1:]
            joined.append(graph.add("time-join", (n,), (_time_join, arrays, n, n + 1 == len(ranges), solved[n], *before)))
        starts = [first for first, _ in ranges]
        columns = {
            at: graph.add("time-column", at, (_time_column, arrays, target, starts, start, count, *joined))
            for at, start, count in _columns(nx, ny)
        }
        wanted = [graph.pyramid(target, parts, columns, "-time"), *solved, *joined]
        _, *counts = _run(graph, wanted, scheduler, retries)
        done = project.apply({"import": {"path": target, "name": name, "origin": {"kind": "geologic-time", "of": source}}}, _moved=True)
    found, known = counts[: len(ranges)], counts[len(ranges) :]
    return {**done, "slabs": len(ranges), "found": sum(found), "known": sum(known) / (nx * ny * nz)}


# Extrema, i, j, k and pictures.


def _extrema_brick(
    path: str, out: str, kind: str, start: tuple[int, int], count: tuple[int, int], version: tuple[str, int]
) -> int:
    import numpy as np
    import zarr

    _same_version(version)
    group = zarr.open_group(_at_hand(out), mode="r+")
    nx, ny, nz = json.loads(_native.volume_info(_at_hand(path)))["levels"][0]
    samples = _native.read_box(path, 0, (*start, 0), (*count, nz)).astype(np.float32)
    live = _native.read_live(path)
    box = (slice(start[0], start[0] + count[0]), slice(start[1], start[1] + count[1]))
    counts, z, amplitude = _native.extrema(samples, kind, np.ascontiguousarray(live[box]))
    most = group["z"].shape[2]
    at = np.arange(most)[None, :] < counts[:, None]
    for name, values in (("z", z), ("amplitude", amplitude)):
        dense = np.full((counts.size, most), np.nan, dtype=np.float32)
        dense[at] = values
        group[name][box] = dense.reshape(*count, most)
    group["count"][box] = counts.reshape(count)
    return int(counts.sum())


def extrema(
    volume: Path,
    out: Path,
    kind: Literal["peak", "trough", "zero"] = "peak",
    *,
    scheduler: Scheduler = None,
    retries: int = RETRIES,
) -> int:
    """Finds the extrema of every trace of a stored volume, refined between samples, and stores them as named arrays.

    Parameters
    ----------
    volume : path
        Folder of the volume.
    out : path
        Folder to write, a Zarr v3 group with ``count`` ``[inline][crossline]`` and ``z``, ``amplitude``
        ``[inline][crossline][extremum]``, from the top down, NaN beyond the count.
    kind : {"peak", "trough", "zero"}
        What is looked for.
    scheduler, retries
        As of :func:`attribute`.

    Returns
    -------
    int
        How many there are.
    """
    import numpy as np
    import zarr

    found = json.loads(_native.volume_info(volume))
    nx, ny, nz = found["levels"][0]
    geometry = Geometry.from_dict(found["info"]["geometry"])
    most = nz // 2 + 1
    path, lines = os.path.abspath(volume), (min(FILE_LINES, nx), min(FILE_LINES, ny))
    axes = ("inline", "crossline", "extremum")
    with written(out) as partial:
        group = zarr.create_group(partial)
        for name in ("z", "amplitude"):
            group.create_array(
                name, shape=(nx, ny, most), chunks=(*lines, most), dtype=np.float32, fill_value=np.nan,
                dimension_names=axes, attributes={"kind": kind},
            )  # fmt: skip
        group.create_array("count", shape=(nx, ny), chunks=lines, dtype=np.uint32, dimension_names=axes[:2])
        _write_lines(group, geometry)
        graph = _Graph(_token(path, partial, kind))
        tasks = [
            graph.add(f"extrema-{kind}", at, (_extrema_brick, path, partial, kind, start, count, _version()))
            for at, start, count in _columns(nx, ny)
        ]
        return int(sum(_run(graph, tasks, scheduler, retries)))


def _parameters_column(
    path: str, out: str, column: tuple[int, int], version: tuple[str, int], *_: Any
) -> tuple[int, int]:
    from petroglyph import open as open_project

    _same_version(version)
    open_project(_at_hand(path))._native.write_parameterization(_at_hand(out), column)
    return column


def parameterize(
    project: Project,
    out: Path,
    *,
    size: Three | None = None,
    scheduler: Scheduler = None,
    retries: int = RETRIES,
) -> Path:
    """Samples i, j, k, layer and block at every sample, a column of files a task, into a Zarr v3 group.

    Parameters
    ----------
    project : Project
        The project; its model and the grids of its parameterization are made first, and are read by every task.
    out : path
        Folder to write: arrays ``i``, ``j``, ``k`` (float32) and ``layer``, ``block`` (uint8, or uint16 where there are more
        than 255), which other projects take in by :meth:`petroglyph.Project.set_parameterization`. Their bytes are those
        that ``petroglyph parameterize`` keeps in the project.
    size : tuple of int, optional
        Samples along each axis; by default those of the survey.
    scheduler, retries
        As of :func:`attribute`.

    Notes
    -----
    A task holds the model, its grids, and one file of each array (128³ samples: 64 MB).
    """
    import zarr

    size = size or project.geometry.shape
    path = os.path.abspath(project.path)
    with written(out) as partial:
        nx, ny, _ = project._native.begin_parameterization(partial, size)
        if size == project.geometry.shape:
            _write_lines(zarr.open_group(partial, mode="r+"), project.geometry)
        graph = _Graph(_token(path, partial, size))
        tasks = [
            graph.add("sample-ijk", (x, y), (_parameters_column, path, partial, (x, y), _version()))
            for x in range(nx)
            for y in range(ny)
        ]
        _run(graph, tasks, scheduler, retries)
        _native.finish_parameterization(partial)
    return out


def _picture(path: str, options: dict[str, Any], version: tuple[str, int]) -> bytes:
    from petroglyph import open as open_project

    _same_version(version)
    return open_project(_at_hand(path)).render(threads=1, **options)._repr_png_()


def render(
    project: Project, pictures: Iterable[Options], *, scheduler: Scheduler = None, retries: int = RETRIES
) -> list[Any]:
    """Draws pictures, sections or maps of a project side by side, each as a task.

    Parameters
    ----------
    project : Project
        The project, on a disk that all workers see.
    pictures : iterable of mapping
        The options of :meth:`petroglyph.Project.render` for each.
    scheduler, retries
        As of :func:`attribute`.

    Returns
    -------
    list of Picture
        In the order of `pictures`.
    """
    from petroglyph._project import Picture

    path = os.path.abspath(project.path)
    wanted = [dict(options) for options in pictures]
    graph = _Graph(_token(path, wanted, len(project.history)))
    version = _version()
    tasks = [graph.add("render", (n,), (_picture, path, options, version)) for n, options in enumerate(wanted)]
    return [Picture(png, {}) for png in _run(graph, tasks, scheduler, retries)]


def _columns(nx: int, ny: int) -> list[tuple[tuple[int, int], tuple[int, int], tuple[int, int]]]:
    return [
        ((x // FILE_LINES, y // FILE_LINES), (x, y), (min(FILE_LINES, nx - x), min(FILE_LINES, ny - y)))
        for x in range(0, nx, FILE_LINES)
        for y in range(0, ny, FILE_LINES)
    ]


def _token(*of: Any) -> str:
    from dask.base import tokenize

    return str(tokenize(*of))


def _write_lines(group: Any, geometry: Geometry) -> None:
    """Writes the coordinates of the traces into a group."""
    import numpy as np

    for name, (dims, values, attributes) in geometry.coordinates().items():
        values = np.asarray(values)
        made = group.create_array(
            name, shape=values.shape, chunks=values.shape, dtype=values.dtype, dimension_names=dims, attributes=attributes
        )
        made[...] = values
