"""Stored volumes as labelled arrays, and arrays as stored volumes."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from petroglyph import _native
from petroglyph._errors import PetroglyphError, PetroglyphWarning
from petroglyph._geometry import VERTICAL_NAMES, Geometry
from petroglyph._types import Path, Progress

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import xarray as xr

#: What an array may be: NumPy, xarray, Dask or Zarr.
Array = Any

#: Types that can be stored; others are converted to the first that holds them.
_TYPES = ("int8", "uint8", "int16", "uint16", "int32", "uint32", "float32")


def open_volume(path: Path, *, chunks: Mapping[str, int] | str | None = None) -> xr.DataArray:
    """Opens a stored volume as a labelled array; samples are read when they are used.

    Parameters
    ----------
    path : path
        Folder of the volume, ``PROJECT/volumes/NAME.zarr``.
    chunks : mapping or str, optional
        As of :func:`xarray.open_zarr`: with ``"auto"`` or ``{}`` the array is one of Dask.

    Returns
    -------
    xarray.DataArray
        Axes ``inline``, ``crossline``, ``sample``; coordinates ``cdp_x``, ``cdp_y`` and ``live``.
    """
    import xarray as xr

    info = json.loads(_native.volume_info(os.fspath(path)))["info"]
    group: Any = xr.open_zarr(os.fspath(path), consolidated=False, chunks=chunking(chunks))
    array: xr.DataArray = group["0"].rename(info.get("quantity") or "amplitude")
    if "cdp_x" not in group:
        array = array.assign_coords(Geometry.from_dict(info["geometry"]).coordinates())
    array = array.assign_coords(live=group["live"].astype(bool))
    told = {"long_name": info.get("quantity"), "units": info.get("unit"), "polarity": info.get("polarity")}
    array.attrs = {key: value for key, value in told.items() if value is not None}
    return array


def chunking(chunks: Mapping[str, int] | str | None) -> Any:
    """What :func:`xarray.open_zarr` takes."""
    return dict(chunks) if isinstance(chunks, Mapping) else chunks


def write_volume(
    path: Path,
    array: Array,
    *,
    geometry: Geometry | None = None,
    live: npt.NDArray[np.bool_] | None = None,
    quantity: str | None = None,
    unit: str | None = None,
    polarity: str | None = None,
    source: str | None = None,
    memory: int | None = None,
    progress: Progress | None = None,
) -> None:
    """Stores an array as a volume, block by block. Nothing is at `path` unless all of it is.

    Parameters
    ----------
    path : path
        Folder to write; what is there already is replaced when the new volume is complete.
    array : array_like
        ``[inline][crossline][sample]``: NumPy, Dask, Zarr, or an :class:`xarray.DataArray` whose coordinates tell the
        geometry and whose coordinate ``live`` or ``trace_mask`` tells the live traces.
    geometry : Geometry, optional
        The lattice; needed where the array has no coordinates.
    live : array_like of bool, optional
        Which traces were recorded, ``[inline][crossline]``; all by default.
    quantity, unit, polarity, source : str, optional
        What the volume says of itself.
    memory : int, optional
        Memory for writing, bytes.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.

    Notes
    -----
    A contiguous NumPy array is read where it is, without a copy of it as a whole. Numbers of eight bytes become
    ``float32``.
    """
    import numpy as np

    values, geometry, live = described(array, geometry, live)
    dtype = storable(values.dtype)
    info: dict[str, Any] = {"geometry": json.loads(geometry.to_json())}
    given = {"quantity": quantity, "unit": unit, "polarity": polarity, "source": source}
    info.update({key: value for key, value in given.items() if value is not None})

    unknown = 0

    def read(x0: int, x1: int, y0: int, y1: int) -> npt.NDArray[Any]:
        nonlocal unknown
        block = np.ascontiguousarray(np.asarray(values[x0:x1, y0:y1, :]), dtype=dtype)
        if live is not None and not live[x0:x1, y0:y1].all():
            # A trace that was not recorded holds zeros, as those of SEG-Y files do.
            block = np.where(live[x0:x1, y0:y1, None], block, dtype.type(0))
        if dtype.kind == "f" and not np.isfinite(block).all():
            unknown += int((~np.isfinite(block)).sum())
            block = np.nan_to_num(block, nan=0.0, posinf=0.0, neginf=0.0)
        return block

    _native.write_volume(path, json.dumps(info), str(dtype), read, live, memory, progress)
    if unknown:
        text = f"{unknown} samples are not numbers (NaN or infinite) and are stored as 0"
        warnings.warn(text, PetroglyphWarning, stacklevel=2)


def storable(dtype: np.dtype[Any]) -> np.dtype[Any]:
    """The type in which samples of `dtype` are stored."""
    import numpy as np

    if str(dtype) in _TYPES:
        return dtype
    if dtype.kind in "fiu":
        return np.dtype(np.float32)
    raise PetroglyphError(f"samples of type {dtype} cannot be stored", f"convert them to one of {', '.join(_TYPES)}")


def described(
    array: Array, geometry: Geometry | None, live: npt.NDArray[np.bool_] | None
) -> tuple[Array, Geometry, npt.NDArray[np.bool_] | None]:
    """The values of an array with three axes, its lattice, and its live traces where they are told."""
    import numpy as np

    values = array
    if hasattr(array, "coords") and hasattr(array, "dims"):
        array = _in_order(array)
        values = array.data
        if geometry is None:
            geometry = _geometry_of(array)
        for name in ("live", "trace_mask"):
            if live is None and name in array.coords:
                live = np.asarray(array.coords[name])
    elif not hasattr(array, "shape"):
        values = np.asarray(array)
    if len(values.shape) != 3:
        raise PetroglyphError(
            f"the array has {len(values.shape)} axes, a volume has three", "give it as [inline][crossline][sample]"
        )
    if geometry is None:
        raise PetroglyphError(
            "the array does not say where it lies", "give geometry=, or an xarray.DataArray with coordinates"
        )
    if tuple(values.shape) != geometry.shape:
        raise PetroglyphError(
            f"the array has {tuple(values.shape)} samples, the geometry {geometry.shape}",
            "give the geometry of this array, as [inline][crossline][sample]",
        )
    if live is not None:
        live = np.ascontiguousarray(np.asarray(live).astype(bool))
        if live.shape != tuple(values.shape[:2]):
            raise PetroglyphError(
                f"the mask of live traces has the shape {live.shape}, the array {tuple(values.shape[:2])} traces",
                "give one value for each trace",
            )
    return values, geometry, live


def _vertical_name(array: xr.DataArray) -> str:
    found = [str(name) for name in array.dims if str(name) in VERTICAL_NAMES]
    if len(found) != 1:
        raise PetroglyphError(
            f"the axes of the array are {', '.join(map(str, array.dims))}",
            f"name them inline, crossline and one of {', '.join(VERTICAL_NAMES)}",
        )
    return found[0]


def _in_order(array: xr.DataArray) -> xr.DataArray:
    name = _vertical_name(array)
    missing = {"inline", "crossline"} - set(map(str, array.dims))
    if missing or len(array.dims) != 3:
        raise PetroglyphError(
            f"the axes of the array are {', '.join(map(str, array.dims))}",
            "name them inline, crossline and sample (xarray's rename does)",
        )
    return array.transpose("inline", "crossline", name)


def _geometry_of(array: xr.DataArray) -> Geometry:
    name = _vertical_name(array)
    missing = [axis for axis in ("inline", "crossline", name) if axis not in array.coords]
    if missing:
        raise PetroglyphError(
            f"the array has no coordinate {missing[0]}", "give it one (xarray's assign_coords), or give geometry="
        )
    vertical = array.coords[name]
    unit = vertical.attrs.get("units") or VERTICAL_NAMES[name] or "ms"
    factors = {"ms": ("ms", 1.0), "s": ("ms", 1000.0), "m": ("m", 1.0), "ft": ("m", 0.3048)}
    if unit not in factors:
        raise PetroglyphError(f"the vertical axis is in {unit}", "state units of ms, s, m or ft")
    unit, factor = factors[unit]
    places = [array.coords[axis].values if axis in array.coords else None for axis in ("cdp_x", "cdp_y")]
    return Geometry.from_coordinates(
        array.coords["inline"].values,
        array.coords["crossline"].values,
        vertical.values * factor,
        places[0],
        places[1],
        unit,
        float(array.attrs.get("velocity_m_s", 2000.0)),
    )
