#!/usr/bin/env python3
"""Opens stores that Petroglyph wrote with Python's zarr and checks what can be checked from outside.

    python bench/check_zarr.py PROJECT.petro/volumes/*.zarr PROJECT.petro/horizons/*.zarr PROJECT.petro/derived/*.zarr
    python bench/check_zarr.py --segy EXPORTED.sgy PROJECT.petro/volumes/NAME.zarr

The second form compares every sample of a volume of floats with the file that `petroglyph export --volume` wrote of it.
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


def distances_sq(point, corners):
    """Squared distances of a point to triangles `[n][3][3]`: to the foot on the plane where it is inside, else to the nearest edge."""
    edges = np.roll(corners, -1, axis=1) - corners
    normal = np.cross(edges[:, 0], -edges[:, 2])
    off = ((point - corners[:, 0]) * normal).sum(1) / (normal**2).sum(1)
    foot = point - off[:, None] * normal
    sides = (np.cross(edges, foot[:, None] - corners) * normal[:, None]).sum(2)
    along = np.clip(((point - corners) * edges).sum(2) / (edges**2).sum(2), 0, 1)
    to_edges = ((point - corners - along[:, :, None] * edges) ** 2).sum(2).min(1)
    return np.where((sides >= 0).all(1), off**2 * (normal**2).sum(1), to_edges)


def check_candidates(path, group, facts):
    distance, leaf = group["distance"][:], group["leaf"][:]
    if list(distance.shape) != facts["size"] or distance.shape != leaf.shape:
        return fail(path, f"distance has {distance.shape}, leaf {leaf.shape}")
    if ((distance == 255) != (leaf == 0)).any() or leaf.max(initial=0) > facts["leaves"]:
        return fail(path, "distances and leaf ids contradict each other")
    forest = group["forest"]
    trace, z, triangles, nodes = (forest[name][:] for name in ("trace", "z", "triangles", "nodes"))
    # A leaf has no children; ids count from 1 in the order of the nodes.
    leaves = nodes[nodes[:, 1] == 0xFFFFFFFF]
    if len(leaves) != facts["leaves"] or (leaves[1:, 4] != leaves[:-1, 5]).any():
        return fail(path, f"{len(leaves)} leaves instead of {facts['leaves']}, or with gaps")
    level, count = (distance, leaf), 0
    while f"pyramid/{count + 1}" in group:
        count += 1
        found = tuple(group[f"pyramid/{count}/{name}"][:] for name in ("distance", "leaf"))
        level = halved(*level)
        if any((a != b).any() if a.shape == b.shape else True for a, b in zip(found, level)):
            return fail(path, f"level {count} does not hold the least of level {count - 1}")
    # Some voxels against all triangles around them.
    corners = np.concatenate([trace[triangles].astype(float), z[triangles][:, :, None].astype(float)], axis=2)
    order = np.argsort(corners[:, :, 0].min(1), kind="stable")
    first = corners[order, :, 0].min(1)
    leaf_of = np.repeat(np.arange(1, len(leaves) + 1), leaves[:, 5] - leaves[:, 4])
    reach, random = facts["max_distance"], np.random.default_rng(1)
    for voxel in random.integers(0, distance.shape, (500, 3)):
        near = order[np.searchsorted(first, voxel[0] - reach - 2) : np.searchsorted(first, voxel[0] + reach + 1)]
        near = near[(np.abs(corners[near, 0] - voxel)[:, 1] <= reach + 1)]
        exact = np.sqrt(distances_sq(voxel.astype(float), corners[near]))
        least, at = exact.min(initial=np.inf), tuple(voxel)
        if distance[at] == 255:
            right = least > reach - 1e-3
        else:
            own = exact[leaf_of[near] == leaf[at]].min(initial=np.inf)
            right = abs(distance[at] * reach / 254 - least) < reach / 508 + 1e-3 and own < least + 1e-3
        if not right:
            return fail(path, f"voxel {voxel}: distance {distance[at]} and leaf {leaf[at]} where {least:.4f} is exact")
    print(f"{path}: candidates of {distance.shape}, {len(leaves)} leaves, {count} levels; 500 voxels are exact")
    return True


def halved(distance, leaf):
    """The least distance of each 2 x 2 x 2 voxels, of equal ones with the lesser leaf."""
    key = distance.astype(np.uint64) << 32 | leaf
    key = np.pad(key, [(0, n % 2) for n in key.shape], constant_values=np.iinfo(np.uint64).max)
    parts = [key[x::2, y::2, z::2] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    least = np.minimum.reduce(parts)
    return (least >> 32).astype(distance.dtype), (least & 0xFFFFFFFF).astype(leaf.dtype)


CHECKS = {
    "volume": check_volume,
    "horizon": check_horizon,
    "parameterization": check_parameterization,
    "candidates": check_candidates,
}


def check(path):
    group = zarr.open_group(path, mode="r")
    header = group.attrs.get("petroglyph")
    if header is None or header["kind"] not in CHECKS:
        return fail(path, "not one of ours")
    return CHECKS[header["kind"]](path, group, header["facts"])


def check_segy(segy, path):
    """Compares every sample with a SEG-Y file of IEEE floats, trace by trace in the order of the lines."""
    array = zarr.open_group(path, mode="r")["0"]
    trace = np.dtype([("header", "V240"), ("samples", ">f4", array.shape[2])])
    samples = np.fromfile(segy, trace, offset=3600)["samples"]
    if len(samples) != array.shape[0] * array.shape[1]:
        return fail(path, f"{segy} has {len(samples)} traces")
    wrong = (samples.reshape(array.shape) != array[:]).sum()
    if wrong:
        return fail(path, f"{wrong} samples differ from {segy}")
    print(f"{path}: all {array.size} samples are those of {segy}")
    return True


if __name__ == "__main__":
    if sys.argv[1:2] == ["--segy"]:
        sys.exit(0 if check_segy(sys.argv[2], sys.argv[3]) else 1)
    sys.exit(0 if all([check(path) for path in sys.argv[1:]]) else 1)
