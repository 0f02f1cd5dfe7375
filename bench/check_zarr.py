#!/usr/bin/env python3
"""Opens stores that Petroglyph wrote with Python's zarr and checks what can be checked from outside.

    python bench/check_zarr.py PROJECT.petro/volumes/*.zarr PROJECT.petro/horizons/*.zarr PROJECT.petro/derived/*.zarr

Needs zarr 3 and numpy. Exit code 1 when something does not fit.
"""

import sys

import numpy as np
import zarr

BRICK = 64


def fail(path, reason):
    print(f"{path}: {reason}")
    return False


def check_volume(path, group, facts):
    axes = ("inlines", "crosslines", "vertical")
    size = tuple(facts["geometry"][axis]["count"] for axis in axes)
    level = 0
    while True:
        array = group[str(level)]
        if array.shape != size:
            return fail(path, f"level {level} has {array.shape}, not {size}")
        ranges = group[f"minmax/{level}"][:]
        live = group["live"][:: 2**level, :: 2**level].astype(bool)
        values = array[:].astype(np.float32)
        values[~live] = np.nan
        for index in np.ndindex(ranges.shape[:3]):
            brick = values[tuple(slice(n * BRICK, (n + 1) * BRICK) for n in index)]
            if np.isnan(brick).all():
                continue
            if not np.allclose(ranges[index], [np.nanmin(brick), np.nanmax(brick)]):
                return fail(path, f"minmax/{level} of brick {index} is {ranges[index]}")
        if max(size) <= BRICK:
            break
        size = tuple((n + 1) // 2 for n in size)
        level += 1
    print(f"{path}: a volume of {group['0'].shape} {group['0'].dtype}, {level + 1} levels")
    return True


def check_horizon(path, group, facts):
    for n, sheet in enumerate(facts["sheets"]):
        depth, quality = group[f"{n}/depth"][:], group[f"{n}/quality"][:]
        if list(depth.shape) != sheet["grid"]["count"] or depth.shape != quality.shape:
            return fail(path, f"sheet {n} has {depth.shape}, quality {quality.shape}")
        if (np.isnan(depth) != (quality == 0)).any():
            return fail(path, f"sheet {n}: holes and qualities differ")
    print(f"{path}: the horizon {facts['name']!r} of {len(facts['sheets'])} sheets")
    return True


def check_parameterization(path, group, facts):
    outside = np.isnan(group["k"][:])
    for name in ("i", "j", "k", "layer", "block"):
        values = group[name][:]
        if list(values.shape) != facts["size"]:
            return fail(path, f"{name} has {values.shape}")
        none = np.isnan(values) if values.dtype.kind == "f" else values == np.iinfo(values.dtype).max
        if values.dtype.kind == "f" and (none != outside).any():
            return fail(path, f"{name} and k are defined in different places")
    print(f"{path}: a parameterization of {tuple(facts['size'])}")
    return True


CHECKS = {"volume": check_volume, "horizon": check_horizon, "parameterization": check_parameterization}


def check(path):
    group = zarr.open_group(path, mode="r")
    header = group.attrs.get("petroglyph")
    if header is None or header["kind"] not in CHECKS:
        return fail(path, "not one of ours")
    return CHECKS[header["kind"]](path, group, header["facts"])


if __name__ == "__main__":
    sys.exit(0 if all([check(path) for path in sys.argv[1:]]) else 1)
