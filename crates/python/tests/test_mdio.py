"""MDIO v1 datasets, read and written."""

import json

import numpy as np
import petroglyph
import pytest

xarray = pytest.importorskip("xarray")
zarr = pytest.importorskip("zarr")
from petroglyph import mdio  # noqa: E402


def dataset(path, *, mask=None, dims=("inline", "crossline", "time"), version="1.1.3"):
    """A dataset as MDIO 1.1 writes it: blosc, NaN and NaN places where no trace is."""
    geometry = petroglyph.Geometry((100, 2, 7), (500, 1, 6), (0.0, 4.0, 9), "ms", (4e5, 6e6), (25.0, 0.0), (0.0, 12.5))
    lines = geometry.coordinates()
    random = np.random.default_rng(1)
    samples = random.standard_normal(geometry.shape).astype(np.float32)
    mask = np.ones((7, 6), dtype=bool) if mask is None else mask
    samples[~mask] = np.nan
    group = zarr.create_group(
        path, attributes={"apiVersion": version, "name": "PostStack3DTime", "attributes": {"defaultVariableName": "amplitude"}}
    )

    def put(name, values, axes, fill, attributes=None):
        made = group.create_array(
            name, shape=values.shape, chunks=tuple(min(4, n) for n in values.shape), dtype=values.dtype, fill_value=fill,
            dimension_names=axes, attributes=attributes or {}, compressors=zarr.codecs.BloscCodec(cname="zstd"),
        )  # fmt: skip
        made[...] = values

    put("inline", np.asarray(lines["inline"][1]), ("inline",), 2147483647)
    put("crossline", np.asarray(lines["crossline"][1]), ("crossline",), 2147483647)
    put("time", np.arange(9, dtype=np.int32) * 4, ("time",), 2147483647)
    for name in ("cdp_x", "cdp_y"):
        put(name, np.where(mask, lines[name][1], np.nan), ("inline", "crossline"), np.nan, {"unitsV1": {"length": "m"}})
    put("trace_mask", mask, ("inline", "crossline"), False, {"coordinates": "cdp_x cdp_y"})
    put("amplitude", samples, dims, np.nan, {"coordinates": "cdp_x cdp_y"})
    return geometry, samples


def test_a_dataset_becomes_a_project(tmp_path):
    geometry, samples = dataset(tmp_path / "a.mdio")
    project = mdio.import_volume(tmp_path / "a.mdio", tmp_path / "a.petro")
    assert project.geometry == geometry
    assert np.array_equal(project.volume().numpy(), samples)


def test_missing_traces_stay_missing_and_leave_no_hole_in_the_lattice(tmp_path):
    mask = np.ones((7, 6), dtype=bool)
    mask[0, 0] = mask[3, 2] = mask[6] = False
    geometry, samples = dataset(tmp_path / "a.mdio", mask=mask)
    project = mdio.import_volume(tmp_path / "a.mdio", tmp_path / "a.petro")
    volume = project.volume()
    assert project.geometry == geometry
    assert np.array_equal(volume.live(), mask) and volume.live_traces == mask.sum()
    assert np.array_equal(volume.numpy()[mask], samples[mask]) and not volume.numpy()[~mask].any()
    mdio.import_volume(tmp_path / "a.mdio", project, name="again")
    assert project.volumes == ["seismic", "again"]


def test_what_is_written_is_read_again(tmp_path):
    mask = np.ones((7, 6), dtype=bool)
    mask[2, 3] = False
    _, samples = dataset(tmp_path / "a.mdio", mask=mask)
    project = mdio.import_volume(tmp_path / "a.mdio", tmp_path / "a.petro")
    mdio.write(project.volume().xarray(), tmp_path / "b.mdio", chunks=(4, 4, 4))
    found = xarray.open_zarr(tmp_path / "b.mdio", consolidated=False)
    assert found["amplitude"].dims == ("inline", "crossline", "time")
    assert np.array_equal(found["amplitude"].values, samples, equal_nan=True)
    assert np.array_equal(found["trace_mask"].values, mask)
    stats = json.loads(found["amplitude"].attrs["statsV1"])
    assert stats["count"] == mask.sum() * 9 and stats["min"] == pytest.approx(float(np.nanmin(samples)))
    again = mdio.import_volume(tmp_path / "b.mdio", tmp_path / "b.petro")
    assert again.document["volumes"][0]["hash"] == project.document["volumes"][0]["hash"]
    with pytest.raises(petroglyph.PetroglyphError, match="exists already"):
        mdio.write(project.volume().xarray(), tmp_path / "b.mdio")


def test_the_library_itself_opens_what_is_written(tmp_path):
    library = pytest.importorskip("mdio")
    dataset(tmp_path / "a.mdio")
    project = mdio.import_volume(tmp_path / "a.mdio", tmp_path / "a.petro")
    mdio.write(project.volume().xarray(), tmp_path / "b.mdio")
    found = library.open_mdio(tmp_path / "b.mdio")
    assert np.array_equal(found["amplitude"].values, project.volume().numpy())


def test_what_is_no_volume_is_told(tmp_path):
    with pytest.raises(petroglyph.PetroglyphError, match="does not exist"):
        mdio.open(tmp_path / "nowhere.mdio")
    dataset(tmp_path / "old.mdio", version="0.9")
    with pytest.raises(petroglyph.PetroglyphError, match="its apiVersion is 0.9"):
        mdio.open(tmp_path / "old.mdio")
    dataset(tmp_path / "gather.mdio", dims=("inline", "offset", "time"))
    with pytest.raises(petroglyph.PetroglyphError, match="no stacked 3D volume"):
        mdio.import_volume(tmp_path / "gather.mdio", tmp_path / "a.petro")
    dataset(tmp_path / "a.mdio")
    with pytest.raises(petroglyph.PetroglyphError, match="choose one of amplitude"):
        mdio.open(tmp_path / "a.mdio", variable="velocity")
    (tmp_path / "empty").mkdir()
    with pytest.raises(petroglyph.PetroglyphError, match="cannot be read"):
        mdio.open(tmp_path / "empty")
    assert not (tmp_path / "a.petro").exists()
