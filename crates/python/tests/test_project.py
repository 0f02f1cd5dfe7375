"""Projects: data as arrays, pictures, errors, cancelling."""

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import petroglyph
import pytest
from petroglyph import _native


def test_importing_takes_no_time():
    """Libraries that take long to load are loaded when they are used (docs/python.md measures the time)."""
    code = "import sys, petroglyph; print([m for m in ('numpy', 'xarray', 'zarr', 'dask', 'distributed') if m in sys.modules])"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert told.strip() == "[]"


def test_a_volume_is_read_whole_by_box_and_by_level(project):
    volume = project.volume()
    whole = volume.numpy()
    assert whole.shape == volume.shape == (40, 36, 48) and str(whole.dtype) == volume.dtype_name
    assert np.array_equal(volume[3], whole[3])
    assert np.array_equal(volume[-1, 2:9:3, 5], whole[-1, 2:9:3, 5])
    assert np.array_equal(volume[..., 7], whole[..., 7])
    assert volume[4:4].shape == (0, 36, 48)
    assert volume.live().all() and volume.geometry == project.geometry
    with pytest.raises(IndexError):
        volume[40]
    with pytest.raises(petroglyph.PetroglyphError, match="no level 9"):
        volume.numpy(level=9)


def test_arrays_are_the_memory_that_rust_has_filled():
    array, address = _native.handed_over(1000)
    assert array.ctypes.data == address
    assert not array.flags.owndata and array.base is not None
    assert array.flags.writeable and array.sum() == 1000.0


def test_arrays_that_come_in_are_read_where_they_are():
    array = np.ones((4, 5, 6), dtype=np.float32)
    assert _native.seen_at(array) == array.ctypes.data
    with pytest.raises(ValueError, match="contiguous"):
        _native.seen_at(array.transpose(2, 1, 0))


def test_xarray_opens_a_stored_volume_with_labels(project):
    xarray = pytest.importorskip("xarray")
    volume = project.volume()
    group = xarray.open_zarr(volume.path, consolidated=False)
    geometry = project.geometry
    assert group["0"].dims == ("inline", "crossline", "sample")
    assert np.array_equal(group["0"].values, volume.numpy())
    assert list(group["inline"].values) == [geometry.inlines[0] + geometry.inlines[1] * n for n in range(40)]
    assert group["sample"].attrs["units"] == geometry.unit and group["cdp_x"].attrs["units"] == "m"
    x = geometry.origin[0] + 3 * geometry.inline_vector[0] + 5 * geometry.crossline_vector[0]
    assert group["0"].coords["cdp_x"].values[3, 5] == pytest.approx(x)
    labelled = volume.xarray()
    line = int(labelled.inline[7])
    assert np.array_equal(labelled.sel(inline=line).values, volume[7])
    assert petroglyph.open_volume(volume.path).name == "amplitude"


def test_arrays_go_in_and_come_out_the_same(project):
    xarray = pytest.importorskip("xarray")
    volume = project.volume()
    doubled = volume.xarray() * 2
    project.add_volume("doubled", doubled.drop_vars("live"))
    assert np.array_equal(project.volume("doubled").numpy(), volume.numpy() * 2)
    assert project.document["volumes"][1].get("geometry") is None, "it lies on the project's lattice"
    counts = np.arange(40 * 36 * 48, dtype=np.int64).reshape(40, 36, 48)
    project.add_volume("counts", counts)
    assert np.array_equal(project.volume("counts").numpy(), counts.astype(np.float32))
    live = np.ones((40, 36), dtype=bool)
    live[3, 4] = False
    project.add_volume("holes", volume.numpy(), live=live)
    assert np.array_equal(project.volume("holes").live(), live)
    assert not project.volume("holes").numpy()[3, 4].any()
    assert isinstance(project.volume("holes").xarray(), xarray.DataArray)
    assert project.check()


def test_horizons_and_faults_go_in_and_come_out(project):
    depth = project.horizon("Bravo").numpy()
    assert depth.shape[1:] == (40, 36)
    shifted = depth[0] + 6.0
    shifted[5, 6] = np.nan
    project.add_horizon_array("Below Bravo", shifted)
    again = project.horizon("Below Bravo").numpy()[0]
    known = np.isfinite(shifted)
    assert np.array_equal(np.isfinite(again), known)
    assert np.abs(again[known] - shifted[known]).max() < 1e-3
    assert (project.horizon("Bravo").quality() > 0).any()
    fault = project.fault("F1")
    assert fault.vertices.shape[1] == 3 and fault.triangles.max() < len(fault.vertices)
    project.add_fault_array("F2", fault.vertices + [400.0, 0.0, 0.0], fault.triangles)
    copy = project.fault("F2")
    assert copy.triangles.shape == fault.triangles.shape
    assert np.abs(copy.vertices - fault.vertices - [400.0, 0.0, 0.0]).max() < 1e-3


def test_horizons_are_labelled(project):
    pytest.importorskip("xarray")
    horizon = project.horizon("Bravo").xarray()
    assert horizon.dims == ("inline", "crossline") and horizon.attrs["units"] == project.geometry.unit
    project.add_horizon_array("Labelled", horizon + 9.0)
    again = project.horizon("Labelled").sheet()
    assert np.nanmax(np.abs(again - horizon.values - 9.0)) < 1e-3
    assert project.fault("F1").xarray().sizes["axis"] == 3


def test_layer_coordinates_are_arrays(project):
    pytest.importorskip("xarray")
    whole = project.parameterization()
    assert set(whole.data_vars) == {"i", "j", "k", "layer", "block"}
    inside = whole["layer"].values != 65535
    k = whole["k"].values[inside]
    assert inside.any() and k.min() > -1e-3 and k.max() < 1.001
    part = project.parameterization(box=(slice(3, 9), slice(0, 36), slice(10, 30)), threads=1)
    for name in whole.data_vars:
        assert np.array_equal(part[name].values, whole[name].values[3:9, :, 10:30], equal_nan=True), name
    assert list(part.inline.values) == list(whole.inline.values[3:9])
    assert project.parameterize()["layers"] == len(project.layers)


def test_pictures_are_pixels_and_png(project, tmp_path):
    picture = project.render(size="120x90", cut="nearest,0.4,0.4")
    pixels = picture.numpy()
    assert pixels.shape == (90, 120, 4) and pixels.dtype == np.uint8
    assert pixels.std() > 5, "it shows something"
    assert picture._repr_png_().startswith(b"\x89PNG")
    picture.save(tmp_path / "block.png")
    assert (tmp_path / "block.png").read_bytes() == picture._repr_png_()
    assert np.array_equal(np.asarray(picture), pixels)
    assert project.render(size="120x90", cut="nearest,0.4,0.4", threads=1)._repr_png_() == picture._repr_png_()
    report = project.figure(tmp_path / "section.pdf", inline=str(project.geometry.inlines[0] + 4))
    assert report["file"].endswith("section.pdf") and (tmp_path / "section.pdf").stat().st_size > 1000


def test_errors_are_those_of_the_command_line(project, tmp_path):
    with pytest.raises(petroglyph.PetroglyphError) as caught:
        petroglyph.open(tmp_path / "nowhere.petro")
    with pytest.raises(petroglyph.PetroglyphError) as told:
        petroglyph.program.info(tmp_path / "nowhere.petro")
    assert caught.value.hint and "nowhere.petro" in told.value.reason
    with pytest.raises(petroglyph.PetroglyphError) as caught:
        project.remove_horizon("Zulu")
    with pytest.raises(petroglyph.PetroglyphError) as told:
        petroglyph.program.horizon_remove(project.path, "Zulu")
    assert (caught.value.reason, caught.value.hint) == (told.value.reason, told.value.hint)
    with pytest.raises(petroglyph.PetroglyphError, match="expected at least 2"):
        petroglyph.program.illustrate("a.sgy", "a.png", layers=1)
    with pytest.raises(petroglyph.PetroglyphError, match="unexpected argument"):
        petroglyph.program.run("info", project.path, frobnicate=True)


def test_a_failure_leaves_the_project_as_it_was(project):
    before = (project.path / "project.toml").read_text()
    with pytest.raises(petroglyph.PetroglyphError):
        project.add_volume("other", np.zeros((2, 3, 4), dtype=np.float32))
    with pytest.raises(petroglyph.PetroglyphError, match="cannot be stored"):
        project.add_volume("other", np.zeros((40, 36, 48), dtype=complex))
    assert (project.path / "project.toml").read_text() == before
    assert [path.name for path in project.path.parent.iterdir()] == ["north.petro"]


def test_what_a_block_raises_comes_through(tmp_path):
    def read(*_):
        raise KeyError("not on this disk")

    info = '{"geometry": %s}' % petroglyph.Geometry.regular((4, 4, 4)).to_json()
    with pytest.raises(KeyError, match="not on this disk"):
        _native.write_volume(tmp_path / "a.zarr", info, "float32", read)
    with pytest.raises(ValueError, match="no array of float32"):
        _native.write_volume(tmp_path / "a.zarr", info, "float32", lambda *_: [1.0])
    assert list(tmp_path.iterdir()) == []


def test_warnings_are_pythons(project, tmp_path):
    samples = project.volume().numpy().copy()
    samples[0, 0, 0] = np.nan
    with pytest.warns(petroglyph.PetroglyphWarning, match="not numbers"):
        project.add_volume("unknown", samples)


def test_progress_is_told_on_the_thread_that_called(large):
    told = []
    large.attribute("semblance", "s", progress=lambda *what: told.append((threading.get_ident(), *what)))
    assert {thread for thread, *_ in told} == {threading.get_ident()}
    assert any(total > 0 and done <= total for _, _, done, total in told)


def test_a_callback_that_raises_cancels(large):
    def stop(*_):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        large.attribute("semblance", "s", progress=stop)
    assert "s" not in large.volumes and large.attribute("envelope", "s")


def test_other_threads_go_on_while_it_works(large):
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    large.attribute("semblance", "s")
    done.set()
    thread.join()
    assert counted[0] > 20


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")
def test_ctrl_c_cancels_and_nothing_is_left(large):
    before = sorted(path.name for path in (large.path / "volumes").iterdir())
    began = threading.Event()

    def interrupt():
        began.wait(30)
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        large.attribute("dip", "d", progress=lambda *_: began.set())
    thread.join()
    assert sorted(path.name for path in (large.path / "volumes").iterdir()) == before
    assert petroglyph.open(large.path).volumes == ["seismic"]


def test_lattices_are_found_and_what_is_none_is_refused():
    geometry = petroglyph.Geometry((100, 2, 5), (500, -1, 4), (0.0, 4.0, 6), "ms", (1e5, 2e5), (20.0, 5.0), (-5.0, 20.0))
    lines = geometry.coordinates()
    args = [lines[name][1] for name in ("inline", "crossline", "sample", "cdp_x", "cdp_y")]
    assert petroglyph.Geometry.from_coordinates(*args) == geometry
    holes = [*args[:3], *(np.where(np.arange(20).reshape(5, 4) % 7 == 3, np.nan, place) for place in args[3:])]
    assert petroglyph.Geometry.from_coordinates(*holes) == geometry
    with pytest.raises(petroglyph.PetroglyphError, match="equal steps"):
        petroglyph.Geometry.from_coordinates([1, 2, 4], *args[1:])
    bent = args[3].copy()
    bent[2, 2] += 30.0
    with pytest.raises(petroglyph.PetroglyphError, match="beside the regular lattice"):
        petroglyph.Geometry.from_coordinates(*args[:3], bent, args[4])
