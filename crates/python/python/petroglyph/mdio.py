"""MDIO v1 volumes, read and written as they are.

MDIO v1 is a Zarr group for xarray: a variable ``amplitude`` ``[inline][crossline][time or depth]`` with the coordinates
``cdp_x`` and ``cdp_y``, and ``trace_mask``, which is false where no trace was recorded; units stand in ``unitsV1``.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from datetime import datetime, timezone
from typing import TYPE_CHECKING, Any

from petroglyph._errors import PetroglyphError
from petroglyph._folders import written
from petroglyph._geometry import VERTICAL_NAMES
from petroglyph._stored import chunking, described
from petroglyph._types import Path, Progress

if TYPE_CHECKING:
    import xarray as xr

    from petroglyph._project import Project

#: The version of the layout that is written.
API_VERSION = "1.1.3"


def open(path: Path, *, variable: str | None = None, chunks: Mapping[str, int] | str | None = None) -> xr.DataArray:
    """Opens an MDIO v1 volume as a labelled array; samples are read when they are used.

    Parameters
    ----------
    path : path
        Folder of the dataset.
    variable : str, optional
        Name of the variable; by default the one that the dataset names as its own, or "amplitude".
    chunks : mapping or str, optional
        As of :func:`xarray.open_zarr`.

    Returns
    -------
    xarray.DataArray
        Axes ``inline``, ``crossline`` and ``time`` or ``depth`` with units; coordinates ``cdp_x``, ``cdp_y``, ``trace_mask``.

    Raises
    ------
    PetroglyphError
        It is no MDIO v1 dataset, or no volume after stacking.
    """
    import xarray as xr

    if not os.path.isdir(path):
        raise PetroglyphError(f"{os.fspath(path)} does not exist", "check the name")
    try:
        found: Any = xr.open_zarr(os.fspath(path), consolidated=False, chunks=chunking(chunks))
    except Exception as error:
        raise PetroglyphError(
            f"{os.fspath(path)} cannot be read as a Zarr group: {error}", "check that it is an MDIO v1 dataset"
        ) from error
    if not str(found.attrs.get("apiVersion", "")).startswith("1."):
        raise PetroglyphError(
            f"{os.fspath(path)} is no MDIO v1 dataset: its apiVersion is {found.attrs.get('apiVersion', 'missing')}",
            "convert it by `mdio` to version 1, or read it by xarray and add it as an array",
        )
    about = found.attrs.get("attributes") or {}
    name = variable or about.get("defaultVariableName") or "amplitude"
    if name not in found:
        raise PetroglyphError(
            f"{os.fspath(path)} has no variable {name!r}", f"choose one of {', '.join(sorted(map(str, found.data_vars)))}"
        )
    array: xr.DataArray = found[name]
    vertical = [str(axis) for axis in array.dims if str(axis) in VERTICAL_NAMES]
    if len(array.dims) != 3 or len(vertical) != 1 or not {"inline", "crossline"} <= set(map(str, array.dims)):
        raise PetroglyphError(
            f"{name} of {os.fspath(path)} has the axes {', '.join(map(str, array.dims))}: it is no stacked 3D volume",
            "stack gathers first; volumes have the axes inline, crossline and time or depth",
        )
    axis = array.coords[vertical[0]]
    units = axis.attrs.get("unitsV1") or {}
    unit = units.get("time") or units.get("length") or VERTICAL_NAMES[vertical[0]] or "ms"
    array = array.assign_coords({vertical[0]: axis.assign_attrs(units=unit)})
    if "trace_mask" in found:
        array = array.assign_coords(trace_mask=found["trace_mask"].astype(bool))
    return array


def import_volume(
    path: Path,
    project: Path | Project,
    *,
    name: str = "seismic",
    variable: str | None = None,
    memory: int | None = None,
    progress: Progress | None = None,
) -> Project:
    """Reads an MDIO v1 volume into a project, which is made if it does not exist; missing traces stay missing.

    Parameters
    ----------
    path : path
        Folder of the dataset.
    project : path or Project
        The project.
    name : str
        Name of the volume in the project.
    variable : str, optional
        Name of the variable, as of :func:`open`.
    memory : int, optional
        Memory for writing, bytes.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    from petroglyph import _project

    array = open(path, variable=variable)
    if isinstance(project, _project.Project):
        into = project
    elif os.path.exists(project):
        into = _project.open(project)
    else:
        return _project.import_volume(array, project, name=name, memory=memory, progress=progress)
    into.add_volume(name, array, memory=memory, progress=progress)
    return into


def write(
    array: xr.DataArray, path: Path, *, name: str = "amplitude", chunks: tuple[int, int, int] = (128, 128, 128)
) -> None:
    """Writes a labelled volume as an MDIO v1 dataset. Nothing is at `path` unless all of it is.

    Parameters
    ----------
    array : xarray.DataArray
        A volume with coordinates, as :meth:`petroglyph.Volume.xarray` gives it; ``live`` or ``trace_mask`` tells which
        traces were recorded. One of Dask is written chunk by chunk.
    path : path
        Folder to write.
    name : str
        Name of the variable.
    chunks : tuple of int
        Chunks along the three axes.
    """
    import numpy as np
    import xarray as xr
    import zarr

    values, geometry, live = described(array, None, None)
    mask = np.ones(geometry.shape[:2], dtype=bool) if live is None else live
    lines = geometry.coordinates()
    axis, measure = ("time", "time") if geometry.unit == "ms" else ("depth", "length")
    with written(path) as partial:
        group = zarr.create_group(
            partial,
            attributes={
                "apiVersion": API_VERSION,
                "createdOn": str(datetime.now(timezone.utc)),
                "name": f"PostStack3D{axis.capitalize()}",
                "attributes": {"surveyType": "3D", "gatherType": "stacked", "defaultVariableName": name},
            },
        )
        edges = tuple(min(edge, count) for edge, count in zip(chunks, geometry.shape, strict=True))
        rows = ("inline", "crossline")
        for label, as_dimension in (("inline", "inline"), ("crossline", "crossline"), ("sample", axis)):
            axis_values = np.asarray(lines[label][1])
            if np.array_equal(axis_values, np.round(axis_values)):
                axis_values = axis_values.astype(np.int32)
            units = {"unitsV1": {measure: geometry.unit}} if label == "sample" else {}
            _put(group, as_dimension, axis_values, (as_dimension,), axis_values.shape, units)
        for label in ("cdp_x", "cdp_y"):
            places = np.where(mask, lines[label][1], np.nan)
            _put(group, label, places, rows, places.shape, {"unitsV1": {"length": "m"}}, np.nan)
        _put(group, "trace_mask", mask, rows, mask.shape, {"coordinates": "cdp_x cdp_y"})
        dtype = np.dtype(values.dtype)
        fill = np.nan if dtype.kind == "f" else 0
        attributes: dict[str, Any] = {"coordinates": "cdp_x cdp_y"}
        made = group.create_array(
            name, shape=geometry.shape, chunks=edges, dtype=dtype, fill_value=fill,
            dimension_names=(*rows, axis), attributes=attributes,
        )  # fmt: skip
        total = [0, 0.0, 0.0, np.inf, -np.inf]
        edge = edges[0]
        for x in range(0, geometry.shape[0], edge):
            block = np.asarray(values[x : x + edge]).copy()
            recorded = block[mask[x : x + edge]].astype(float)
            block[~mask[x : x + edge]] = fill
            made[x : x + edge] = block
            if recorded.size:
                total[0] += recorded.size
                total[1] += float(recorded.sum())
                total[2] += float((recorded**2).sum())
                total[3], total[4] = min(total[3], float(recorded.min())), max(total[4], float(recorded.max()))
        if total[0]:
            keys = ("count", "sum", "sumSquares", "min", "max")
            stats = {**dict(zip(keys, total, strict=True)), "histogram": {"counts": [], "binCenters": []}}
            made.update_attributes({**attributes, "statsV1": json.dumps(stats)})
        xr.open_zarr(partial, consolidated=False).close()


def _put(
    group: Any, name: str, values: Any, axes: tuple[str, ...], chunks: tuple[int, ...], attributes: Any, fill: Any = None
) -> None:
    made = group.create_array(
        name, shape=values.shape, chunks=chunks, dtype=values.dtype, dimension_names=axes, attributes=attributes,
        fill_value=fill,
    )  # fmt: skip
    made[...] = values
