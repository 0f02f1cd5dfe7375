"""Stages as graphs: the same bytes on any scheduler, for any tiling, with workers lost."""

import contextlib
import json
import os
import pickle
import shutil
import time
from pathlib import Path

import numpy as np
import petroglyph
import pytest
from petroglyph import _native, bricks

dask = pytest.importorskip("dask")
distributed = pytest.importorskip("distributed")
import petroglyph.dask  # noqa: E402


def contents(folder):
    """Every file below a folder, with its bytes."""
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(Path(folder).rglob("*")) if path.is_file()}


def same(project, one, other):
    """Whether two volumes are the same bytes but for the names they were given."""
    a, b = contents(project.volume(one).path), contents(project.volume(other).path)
    assert a.keys() == b.keys()
    different = [name for name in a if name != "zarr.json" and a[name] != b[name]]
    return not different and json.loads(a["zarr.json"]) == json.loads(b["zarr.json"])


@pytest.fixture(scope="module")
def cluster():
    """A cluster of two processes on this machine."""
    with dask.config.set({"distributed.comm.timeouts.connect": "60s", "distributed.scheduler.allowed-failures": 5}):
        with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as made:
            with distributed.Client(made) as client:
                yield client


@pytest.mark.parametrize("kind", ["envelope", "semblance", "fault-likelihood", "throw", "dip"])
def test_a_graph_writes_the_bytes_of_the_program(large, kind):
    large.attribute(kind, "whole")
    done = petroglyph.dask.attribute(large, kind, "parted", scheduler="synchronous")
    assert "parted" in done
    for suffix in ("", "-inline", "-crossline") if kind == "dip" else ("",):
        assert same(large, f"whole{suffix}", f"parted{suffix}"), suffix
    assert large.document["volumes"][-1]["hash"]
    hashes = {entry["name"]: entry["hash"] for entry in large.document["volumes"]}
    assert hashes["whole"] == hashes["parted"]
    assert [path.name for path in large.path.parent.iterdir()] == ["large.petro"]


@pytest.mark.parametrize("memory", [1 << 40, 50 << 20, 1])
def test_pieces_of_any_size_give_the_same_bytes(large, memory):
    large.attribute("semblance", "whole")
    petroglyph.dask.attribute(large, "semblance", "parted", scheduler="threads", memory=memory)
    assert same(large, "whole", "parted")


@pytest.mark.parametrize("shape", [(1, 1), (3, 150), (37, 23), (128, 140), (149, 7)])
def test_bricks_of_every_odd_shape_agree_with_the_whole(large, shape):
    samples, live = large.volume().numpy()[:, :, :20].copy(), large.volume().live()
    reach = bricks.halo("semblance")
    whole = bricks.semblance(samples, live)
    nx, ny, _ = samples.shape
    random = np.random.default_rng(sum(shape))
    for _ in range(4):
        x, y = int(random.integers(0, nx - shape[0] + 1)), int(random.integers(0, max(ny - shape[1], 0) + 1))
        ends = (min(x + shape[0], nx), min(y + shape[1], ny))
        low, high = (max(x - reach, 0), max(y - reach, 0)), (min(ends[0] + reach, nx), min(ends[1] + reach, ny))
        box = (slice(low[0], high[0]), slice(low[1], high[1]))
        part = bricks.semblance(np.ascontiguousarray(samples[box]), np.ascontiguousarray(live[box]))
        inner = part[x - low[0] : ends[0] - low[0], y - low[1] : ends[1] - low[1]]
        assert inner.tobytes() == np.ascontiguousarray(whole[x : ends[0], y : ends[1]]).tobytes()


def test_two_processes_write_the_same_bytes_and_tasks_have_names(large, cluster):
    large.attribute("semblance", "whole")
    seen = []
    original = petroglyph.dask._run
    petroglyph.dask._run = lambda graph, *rest: seen.append(graph.counts) or original(graph, *rest)
    try:
        petroglyph.dask.attribute(large, "semblance", "parted", scheduler=cluster)
    finally:
        petroglyph.dask._run = original
    assert same(large, "whole", "parted")
    plan = petroglyph.dask.plan(large.volume().path, "semblance")
    assert all(seen[0][stage] == count for stage, count in plan.tasks.items())
    assert {"semblance", "halve-1"} <= set(plan.tasks)


def test_one_and_four_workers_write_the_same_bytes(large):
    large.attribute("envelope", "whole")
    for workers in (1, 4):
        with distributed.LocalCluster(
            n_workers=workers, threads_per_worker=1, processes=workers == 1, dashboard_address=None
        ) as made, distributed.Client(made) as client:
            petroglyph.dask.attribute(large, "envelope", f"on-{workers}", scheduler=client)
        assert same(large, "whole", f"on-{workers}")


def kill_once(marker, *_):
    """Kills the process that runs this, the first time."""
    try:
        os.close(os.open(marker, os.O_CREAT | os.O_EXCL))
    except FileExistsError:
        return
    time.sleep(0.1)
    os._exit(17)


def test_a_worker_that_is_killed_in_the_middle_changes_nothing(large, cluster, tmp_path, monkeypatch):
    large.attribute("semblance", "whole")
    marker = str(tmp_path / "killed")
    original = petroglyph.dask._attribute_graph

    def with_a_killer(*args):
        graph, wanted = original(*args)
        stage, *rest = next(key for key in graph.tasks if key[0].startswith("halve-1"))
        killer = ("killer", 0)
        graph.tasks[killer] = (kill_once, marker)
        call = graph.tasks[(stage, *rest)]
        graph.tasks[(stage, *rest)] = (*call, killer)
        return graph, wanted

    monkeypatch.setattr(petroglyph.dask, "_attribute_graph", with_a_killer)
    cluster.register_plugin(_Importable(str(Path(__file__).parent)))
    petroglyph.dask.attribute(large, "semblance", "parted", scheduler=cluster)
    assert os.path.exists(marker), "a worker was killed"
    assert same(large, "whole", "parted")


def with_a_killer(monkeypatch, cluster, stage, marker):
    """Kills the worker that is about to do the last task of a stage, once."""
    original = petroglyph.dask._run

    def run(graph, *args):
        key = [key for key in graph.tasks if key[0].startswith(stage)][-1]
        killer = (f"killer-{stage}", 0)
        graph.tasks[killer] = (kill_once, str(marker))
        graph.tasks[key] = (*graph.tasks[key], killer)
        return original(graph, *args)

    monkeypatch.setattr(petroglyph.dask, "_run", run)
    cluster.register_plugin(_Importable(str(Path(__file__).parent)))


def test_layer_coordinates_and_time_survive_a_killed_worker(project, large, cluster, tmp_path, monkeypatch):
    project.parameterize(size="140x131x129")
    large.extract(memory=1 << 40)
    with pytest.warns(petroglyph.PetroglyphWarning, match="more than the memory that was stated"):
        large.time(name="whole", memory=1)
    with monkeypatch.context() as patch:
        with_a_killer(patch, cluster, "sample-ijk", tmp_path / "first")
        petroglyph.dask.parameterize(project, tmp_path / "p.zarr", size=(140, 131, 129), scheduler=cluster)
    whole = contents(project.path / "derived" / "parameterization.zarr")
    assert contents(tmp_path / "p.zarr") == whole
    with monkeypatch.context() as patch:
        with_a_killer(patch, cluster, "time-join", tmp_path / "second")
        petroglyph.dask.time(large, "parted", memory=1, scheduler=cluster)
    assert same(large, "whole", "parted")
    assert os.path.exists(tmp_path / "first") and os.path.exists(tmp_path / "second"), "workers were killed"


class _Importable(distributed.WorkerPlugin):
    """Lets workers, and those that take the place of lost ones, import this file."""

    def __init__(self, folder):
        self.folder = folder

    def setup(self, worker):
        import sys

        sys.path.insert(0, self.folder)


def test_extrema_are_named_arrays(large, tmp_path):
    xarray = pytest.importorskip("xarray")
    path = large.volume().path
    total = petroglyph.dask.extrema(path, tmp_path / "peaks.zarr", "peak", scheduler="threads")
    found = xarray.open_zarr(tmp_path / "peaks.zarr", consolidated=False)
    counts, z, amplitude = bricks.extrema(large.volume().numpy(), "peak", large.volume().live())
    assert int(found["count"].sum()) == total == counts.sum()
    assert np.array_equal(found["count"].values.ravel(), counts)
    dense = found["z"].values.reshape(counts.size, -1)
    assert np.array_equal(dense[np.isfinite(dense)], z)
    assert found["z"].dims == ("inline", "crossline", "extremum") and "cdp_x" in found
    with pytest.raises(petroglyph.PetroglyphError, match="exists already"):
        petroglyph.dask.extrema(path, tmp_path / "peaks.zarr")


def test_layer_coordinates_of_tasks_are_those_of_the_program(project, tmp_path):
    xarray = pytest.importorskip("xarray")
    for name, size in (("survey", None), ("odd", (140, 131, 129))):
        out = tmp_path / f"{name}.zarr"
        petroglyph.dask.parameterize(project, out, size=size, scheduler="threads")
        text = "x".join(map(str, size or project.geometry.shape))
        project.parameterize(size=text, memory="64M")
        for array in ("i", "j", "k", "layer", "block"):
            whole = contents(project.path / "derived" / "parameterization.zarr" / array)
            assert contents(out / array) == whole, (name, array)
        assert not (out / ".apart").exists()
    found = xarray.open_zarr(tmp_path / "survey.zarr", consolidated=False)
    assert found["k"].sizes["inline"] == found["inline"].size == project.geometry.shape[0]
    project.set_parameterization(tmp_path / "survey.zarr")
    assert "parameterization" in project.document


def test_layer_coordinates_with_a_file_missing_are_refused(project, tmp_path):
    project._native.begin_parameterization(tmp_path / "p.zarr", (140, 20, 30))
    project._native.write_parameterization(tmp_path / "p.zarr", (0, 0))
    with pytest.raises(petroglyph.PetroglyphError, match="not written to its end"):
        petroglyph._native.finish_parameterization(tmp_path / "p.zarr")


def test_pictures_are_drawn_side_by_side(project):
    line = project.geometry.inlines[0]
    options = [{"inline": str(line + n), "size_cm": "6x4", "dpi": 60} for n in (2, 20)]
    drawn = petroglyph.dask.render(project, options, scheduler="threads")
    assert [one._repr_png_() for one in drawn] == [project.render(**option)._repr_png_() for option in options]
    assert drawn[0]._repr_png_() != drawn[1]._repr_png_()


# Geologic time.


@pytest.mark.parametrize("memory", [1, 1 << 40])
def test_geologic_time_in_slabs_is_that_of_the_program(large, whole, memory, cluster):
    """Two slabs, and one; on one thread after the other, and on two processes."""
    large.extract(memory=1 << 40)
    # What is stated to the program is a whole number of bytes too.
    is_too_little = pytest.warns(petroglyph.PetroglyphWarning, match="more than the memory that was stated")
    with is_too_little if memory == 1 else contextlib.nullcontext():
        told = large.time(name="whole", memory=memory)
    for name, scheduler in (("parted", "synchronous"), ("spread", cluster)):
        done = petroglyph.dask.time(large, name, memory=memory, scheduler=scheduler)
        assert same(large, "whole", name)
        assert done["slabs"] == told["slabs"] == (2 if memory == 1 else 1)
        assert done["known"] == pytest.approx(told["known"]) and done["known"] > 0.5
    assert sorted(path.name for path in large.path.parent.iterdir()) == ["large.petro"]


def test_geologic_time_without_candidates_is_a_sentence(large):
    with pytest.raises(petroglyph.PetroglyphError, match="candidates"):
        petroglyph.dask.time(large)
    assert [path.name for path in large.path.parent.iterdir()] == ["large.petro"]


# Horizon candidates.


@pytest.fixture(scope="module")
def whole(larger, tmp_path_factory):
    """The files of the candidates that the program extracts in one piece."""
    path = tmp_path_factory.mktemp("whole") / "large.petro"
    shutil.copytree(larger.path, path)
    done = petroglyph.open(path).extract(memory=1 << 40)
    assert done["surfaces"] > 5 and done["triangles"] > 100_000 and done["computed"]
    return candidates(path)


def candidates(path):
    return contents(Path(path) / "derived" / "candidates.zarr")


def is_tidy(project):
    return [path.name for path in (project.path / "derived").iterdir()] == ["candidates.zarr"]


@pytest.mark.parametrize("edge", [128, 61, 34])
def test_candidates_in_bricks_of_any_size_are_those_of_one_piece(large, whole, edge):
    done = petroglyph.dask.extract(large, edge=edge, scheduler="threads")
    assert candidates(large.path) == whole
    assert done["surfaces"] > 5 and is_tidy(large)
    assert large.history[-1]["in_effect"] and "extraction" in large.document
    # Asked for again they are there, as they are for the program's own command.
    assert petroglyph.dask.extract(large, edge=edge)["triangles"] == done["triangles"]
    assert not large.extract()["computed"]


@pytest.mark.parametrize("workers", [1, 4])
def test_one_and_four_workers_extract_the_same_candidates(large, whole, workers):
    with distributed.LocalCluster(
        n_workers=workers, threads_per_worker=1, processes=workers == 1, dashboard_address=None
    ) as made, distributed.Client(made) as client:
        petroglyph.dask.extract(large, edge=75, scheduler=client)
    assert candidates(large.path) == whole and is_tidy(large)


@pytest.mark.parametrize("stage", ["evidence", "trees"])
def test_candidates_are_the_same_when_a_worker_is_killed_in_the_middle(large, whole, cluster, tmp_path, monkeypatch, stage):
    marker = str(tmp_path / "killed")
    original = petroglyph.dask._candidates_graph

    def with_a_killer(*plan):
        graph, wanted = original(*plan)
        killer = ("killer", 0)
        # Once the stage before is done, whose answers are lost with the worker.
        victims = [key for key in graph.tasks if key[0].startswith(f"{stage}-") and len(key) == 2]
        graph.tasks[killer] = (kill_once, marker, graph.tasks[victims[0]][-1])
        for victim in victims[1:]:
            graph.tasks[victim] = (*graph.tasks[victim], killer)
        assert len(victims) > 1
        return graph, wanted

    monkeypatch.setattr(petroglyph.dask, "_candidates_graph", with_a_killer)
    cluster.register_plugin(_Importable(str(Path(__file__).parent)))
    petroglyph.dask.extract(large, edge=70, scheduler=cluster)
    assert os.path.exists(marker), "a worker was killed"
    assert candidates(large.path) == whole and is_tidy(large)


def test_an_interrupted_extraction_goes_on_where_it_was(large, whole, monkeypatch):
    original = petroglyph.dask._candidates_task

    def interrupted(plan, stage, slot, *rest):
        if stage == "labels" and slot == 2:
            raise KeyboardInterrupt
        original(plan, stage, slot, *rest)

    monkeypatch.setattr(petroglyph.dask, "_candidates_task", interrupted)
    with pytest.raises(KeyboardInterrupt):
        petroglyph.dask.extract(large, edge=60, scheduler="synchronous")
    assert "extraction" not in large.document
    left = [path.name for path in (large.path / "derived" / "unfinished").glob("*/arrays/done-windows/*")]
    assert set(left) == {*map(str, range(9)), "all"}
    monkeypatch.undo()
    # In the same bricks, whatever would be usual now.
    begun = []
    graph_of = petroglyph.dask._candidates_graph
    monkeypatch.setattr(petroglyph.dask, "_candidates_graph", lambda plan, *rest: begun.append(plan) or graph_of(plan, *rest))
    petroglyph.dask.extract(large, scheduler="synchronous")
    assert max(json.loads(begun[0])["edge"]) <= 60
    assert candidates(large.path) == whole and is_tidy(large)


def test_a_plan_of_an_extraction_names_its_tasks_and_too_little_memory_is_said(large):
    before = contents(large.path)
    plan = petroglyph.dask.plan_extraction(large.volume().path, edge=50)
    assert plan.tasks["extrema"] == plan.tasks["labels"] == 9 and plan.tasks["noise"] == 1
    assert plan.tasks["distances"] == plan.tasks["store-columns"] == 4
    assert plan.task_bytes == petroglyph.dask.MEMORY
    for call in (
        lambda: petroglyph.dask.plan_extraction(large.volume().path, memory=1 << 20),
        lambda: petroglyph.dask.extract(large, memory=1 << 20),
    ):
        with pytest.raises(petroglyph.PetroglyphError, match="too few for bricks"):
            call()
    assert contents(large.path) == before


def test_an_extraction_that_cannot_be_done_leaves_nothing(large, monkeypatch):
    before = contents(large.path)
    monkeypatch.setattr(petroglyph.dask.os.path, "isdir", lambda path: not path.endswith("arrays"))
    with pytest.raises(petroglyph.PetroglyphError, match="is not there on the worker"):
        petroglyph.dask.extract(large, scheduler="synchronous")
    monkeypatch.undo()
    graph_of = petroglyph.dask._candidates_graph
    monkeypatch.setattr(petroglyph.dask, "__version__", "9.9.9")

    def on_a_worker_of_another_version(*plan):
        graph = graph_of(*plan)
        monkeypatch.setattr(petroglyph.dask, "__version__", petroglyph.__version__)
        return graph

    monkeypatch.setattr(petroglyph.dask, "_candidates_graph", on_a_worker_of_another_version)
    with pytest.raises(petroglyph.PetroglyphError, match="the client 9.9.9"):
        petroglyph.dask.extract(large, scheduler="synchronous")
    assert contents(large.path) == before


# What goes wrong.


def test_two_versions_are_told_and_nothing_is_written(large, monkeypatch):
    before = contents(large.path)
    monkeypatch.setattr(petroglyph.dask, "__version__", "9.9.9")
    graph_of = petroglyph.dask._attribute_graph

    def on_a_worker_of_another_version(*args):
        graph = graph_of(*args)
        monkeypatch.setattr(petroglyph.dask, "__version__", petroglyph.__version__)
        return graph

    monkeypatch.setattr(petroglyph.dask, "_attribute_graph", on_a_worker_of_another_version)
    with pytest.raises(petroglyph.PetroglyphError, match="the client 9.9.9") as caught:
        petroglyph.dask.attribute(large, "envelope", "e", scheduler="synchronous")
    assert "same version" in caught.value.hint
    assert contents(large.path) == before and [path.name for path in large.path.parent.iterdir()] == ["large.petro"]


def test_a_worker_without_the_store_says_so(large, monkeypatch):
    before = contents(large.path)
    monkeypatch.setattr(petroglyph.dask.os.path, "isdir", lambda path: not str(path).endswith(".zarr"))
    with pytest.raises(petroglyph.PetroglyphError, match="is not there on the worker") as caught:
        petroglyph.dask.attribute(large, "envelope", "e", scheduler="synchronous")
    monkeypatch.undo()
    assert "all workers see" in caught.value.hint
    assert contents(large.path) == before and [path.name for path in large.path.parent.iterdir()] == ["large.petro"]


def test_a_refusal_reaches_the_client_as_it_was():
    error = petroglyph.PetroglyphError("it is not there", "put it there")
    again = pickle.loads(pickle.dumps(error))
    assert (again.reason, again.hint, str(again)) == (error.reason, error.hint, str(error))


def test_an_array_of_other_chunks_is_taken_in(large, tmp_path):
    zarr = pytest.importorskip("zarr")
    geometry = large.geometry
    samples = large.volume().numpy()
    other = zarr.create_array(tmp_path / "other.zarr", shape=samples.shape, chunks=(31, 17, 70), dtype=np.float32)
    other[...] = samples
    large.add_volume("other", other, geometry=geometry, live=large.volume().live())
    hashes = [entry["hash"] for entry in large.document["volumes"]]
    assert hashes[0] == hashes[1], "the same samples, whatever their chunks"
    with pytest.raises(petroglyph.PetroglyphError, match="the array has"):
        large.add_volume("cut", other[:20], geometry=geometry)


def test_a_file_written_by_other_chunks_is_refused(large, tmp_path):
    info = '{"geometry": %s}' % petroglyph.Geometry.regular((150, 4, 5)).to_json()
    parts = _native.VolumeParts.create(tmp_path / "a.zarr", info, "float32")
    with pytest.raises(petroglyph.PetroglyphError, match="where 2560 are needed"):
        parts.write((0, 0, 0), np.zeros((64, 4, 5), dtype=np.float32))
    with pytest.raises(TypeError, match="float32"):
        parts.write((0, 0, 0), np.zeros((128, 4, 5), dtype=np.int16))
    with pytest.raises(petroglyph.PetroglyphError, match="not written to its end"):
        petroglyph.open_volume(tmp_path / "a.zarr")
    with pytest.raises(petroglyph.PetroglyphError, match="not written to its end"):
        parts.finish([])


def peak_bytes(work):
    """What `work` adds to the largest memory of a new process, bytes."""
    import subprocess
    import sys

    code = (
        "import resource, sys\nimport numpy, petroglyph.dask\n"
        "def peak(): return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024\n"
        f"before = peak()\n{work}\nprint(peak() - before)"
    )
    return int(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout)


@pytest.mark.parametrize("kind", ["envelope", "semblance"])
def test_no_task_uses_more_memory_than_is_stated(large, tmp_path, kind):
    source, target = large.volume().path, tmp_path / "t.zarr"
    info = json.dumps({"geometry": json.loads(large.geometry.to_json())})
    _native.VolumeParts.create(target, info, "float32")
    stated = petroglyph.dask.plan(source, kind, memory=40 << 20).task_bytes
    used = peak_bytes(
        "from petroglyph.dask import _Stage, _column, _piece_lines\n"
        f"lines = _piece_lines({kind!r}, 70, 128 * 128, petroglyph.bricks.halo({kind!r}), {40 << 20})\n"
        f"stage = _Stage({kind!r}, {str(source)!r}, ({str(target)!r},), (150, 140, 70), lines, None, None, '', "
        "(petroglyph.__version__, petroglyph.STORE_VERSION))\n"
        f"_column(stage, ({str(source)!r},), (0, 0), (128, 128))"
    )
    assert used <= stated, f"{used} bytes, {stated} stated"


def test_no_task_of_an_extraction_uses_more_memory_than_is_stated(large):
    memory = 24 << 20
    stated = petroglyph.dask.plan_extraction(large.volume().path, memory=memory).task_bytes
    used = peak_bytes(
        f"project = petroglyph.open({str(large.path)!r})\n"
        f"petroglyph.dask.extract(project, memory={memory}, scheduler='synchronous')"
    )
    assert used <= stated, f"{used} bytes, {stated} stated"
