"""What is written beside its place until it is complete: processes at once, folders of others, failures."""

import subprocess
import sys

import numpy as np
import petroglyph
import pytest

pytest.importorskip("zarr")
pytest.importorskip("dask")
from petroglyph import mdio  # noqa: E402
import petroglyph.dask  # noqa: E402

#: Waits in the middle of writing until the other process is there too.
MEET = """
import sys, time
from pathlib import Path
import numpy, petroglyph, petroglyph.dask, petroglyph.mdio
project, out, meeting, own, other = sys.argv[1:]
def meet():
    Path(meeting, own).touch()
    while not Path(meeting, other).exists():
        time.sleep(0.005)
def meeting_first(call):
    return lambda *given: meet() or call(*given)
"""
VOLUME = """
class Array:
    shape, dtype = (40, 36, 48), numpy.dtype("float32")
    def __getitem__(self, box):
        meet()
        return numpy.full([part.indices(count)[1] for part, count in zip(box, self.shape)], float(own), "float32")
petroglyph.open(project).add_volume("same", Array())
"""
NEW_PROJECT = VOLUME.replace(
    'petroglyph.open(project).add_volume("same", Array())',
    "petroglyph.import_volume(Array(), out, geometry=petroglyph.Geometry.regular(Array.shape))",
)
ATTRIBUTE = """
petroglyph.dask._run = meeting_first(petroglyph.dask._run)
petroglyph.dask.attribute(petroglyph.open(project), "envelope", "same", scheduler="synchronous")
"""
EXTREMA = """
petroglyph.dask._run = meeting_first(petroglyph.dask._run)
petroglyph.dask.extrema(petroglyph.open(project).volume().path, out, scheduler="synchronous")
"""
MDIO = """
petroglyph.mdio._put = meeting_first(petroglyph.mdio._put)
petroglyph.mdio.write(petroglyph.open(project).volume().xarray(), out)
"""


@pytest.mark.parametrize(
    "work", [VOLUME, NEW_PROJECT, ATTRIBUTE, EXTREMA, MDIO], ids=["volume", "project", "attribute", "extrema", "mdio"]
)
def test_of_two_processes_at_once_one_writes_and_the_other_is_refused(project, tmp_path, work):
    meeting, out = tmp_path / "meeting", tmp_path / "out"
    meeting.mkdir()
    before = {path.name for path in tmp_path.iterdir()}
    words = [sys.executable, "-c", MEET + work, project.path, out, meeting]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    running = [subprocess.Popen([*words, *own], **pipes) for own in (("1", "2"), ("2", "1"))]
    told = [process.communicate(timeout=120)[1] for process in running]
    codes = [process.returncode for process in running]
    assert sorted(codes) == [0, 1], told
    assert "PetroglyphError" in told[codes.index(1)], told
    assert {path.name for path in tmp_path.iterdir()} - before <= {"out"}
    project.reload()
    if work in (VOLUME, NEW_PROJECT):
        winner = codes.index(0) + 1
        stored = project.volume("same") if work is VOLUME else petroglyph.open(out).volume()
        assert (stored.numpy() == winner).all(), "the samples of the process that was not refused"
    elif work is ATTRIBUTE:
        project.attribute("envelope", "whole")
        assert np.array_equal(project.volume("same").numpy(), project.volume("whole").numpy())
    elif work is EXTREMA:
        assert petroglyph.dask.extrema(project.volume().path, tmp_path / "again", scheduler="synchronous") > 0
    else:
        assert np.array_equal(mdio.open(out).values, project.volume().numpy())


def test_folders_of_others_stay_and_nothing_is_left_of_a_failure(project, tmp_path, monkeypatch):
    labelled = project.volume().xarray()
    for name in ("out.part", ".north.petro.same.zarr"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "own").write_text("kept")
    before = sorted(path for path in tmp_path.iterdir())
    project.add_volume("same", labelled)
    petroglyph.dask.attribute(project, "envelope", "strength", scheduler="synchronous")
    petroglyph.dask.extrema(project.volume().path, tmp_path / "deep" / "peaks", scheduler="synchronous")
    monkeypatch.setattr(petroglyph.dask, "_run", lambda *_: 1 / 0)
    monkeypatch.setattr(mdio, "_put", lambda *_: 1 / 0)
    for fails in (
        lambda: mdio.write(labelled, tmp_path / "out"),
        lambda: petroglyph.dask.extrema(project.volume().path, tmp_path / "out"),
        lambda: petroglyph.dask.attribute(project, "envelope", "again"),
        lambda: petroglyph.dask.parameterize(project, tmp_path / "out"),
    ):
        with pytest.raises(ZeroDivisionError):
            fails()
    assert sorted(path for path in tmp_path.iterdir() if path.name != "deep") == before
    assert all((tmp_path / name / "own").read_text() == "kept" for name in ("out.part", ".north.petro.same.zarr"))
