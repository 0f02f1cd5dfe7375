#!/usr/bin/env python3
"""Times the Python side of the parameterization on the input that `petroglyph bench --dump DIR` wrote.

    python3 -m venv venv && venv/bin/pip install numpy scipy pykdtree
    petroglyph bench --dump DIR
    OMP_NUM_THREADS=2 venv/bin/python bench/peers.py DIR [--scipy]

Input (all written by the dump): `region.npy` uint16 [inline][crossline][sample], layer + layers * block; `sheets.npy`
float32 [horizon][block][x][y], voxel z of the extended sheets; `meta.json` with `size`, `margin` (nodes around the
survey), `metric_m` (m per voxel along x, y, z), `layers`, `blocks`; `amplitude.npy` float32 [inline][crossline][sample], the synthetic
survey that horizon candidates are extracted from. Only closed layers (two horizons) are timed on both sides.

f_z is what P-illus 3.1 describes: a kd-tree over each horizon's nodes, two distances for each voxel, no refinement to the
surface (so k is off by up to the sampling). The trace is a fixed-step walk along the gradient of f_z, vectorised over all voxels.
"""
import argparse
import json
import os
import pathlib
import time

import numpy as np


def horizon_points(sheet, margin, metric):
    """Nodes of one extended sheet in metres, n x 3."""
    nx, ny = sheet.shape
    x, y = np.meshgrid(np.arange(nx) - margin, np.arange(ny) - margin, indexing="ij")
    return np.stack([x.ravel() * metric[0], y.ravel() * metric[1], sheet.ravel() * metric[2]], axis=1).astype(np.float32)


def pykdtree_distances(points, queries):
    from pykdtree.kdtree import KDTree

    return KDTree(points).query(queries)[0]


def scipy_distances(points, queries):
    from scipy.spatial import cKDTree

    return cKDTree(points).query(queries, workers=int(os.environ.get("OMP_NUM_THREADS", "1")))[0]


def f_z(region, sheets, meta, distances):
    """k of every voxel in a closed layer, NaN elsewhere."""
    k = np.full(region.shape, np.nan, np.float32)
    metric = np.array(meta["metric_m"], np.float32)
    layers = meta["layers"]
    for block in range(meta["blocks"]):
        for layer in range(1, layers - 1):
            inside = np.nonzero(region == layer + layers * block)
            if inside[0].size == 0:
                continue
            voxels = np.stack(inside, axis=1).astype(np.float32) * metric
            bottom = horizon_points(sheets[layers - 1 - layer, block], meta["margin"], metric)
            top = horizon_points(sheets[layers - 2 - layer, block], meta["margin"], metric)
            d_bottom, d_top = distances(bottom, voxels), distances(top, voxels)
            k[inside] = d_bottom / np.maximum(d_bottom + d_top, 1e-6)
    return k


def trace(k, region, meta, steps=48):
    """Walks every voxel along the gradient of f_z to k = 0.5; returns the voxel x, y where it arrives."""
    from scipy.ndimage import map_coordinates

    metric = np.array(meta["metric_m"], np.float32)
    filled = np.nan_to_num(k, nan=0.5)
    gradient = [g / metric[a] for a, g in enumerate(np.gradient(filled))]
    inside = np.nonzero(~np.isnan(k))
    p = np.stack(inside).astype(np.float32)
    active = np.arange(p.shape[1])
    for _ in range(steps):
        at = p[:, active]
        value = map_coordinates(filled, at, order=1, mode="nearest")
        g = np.stack([map_coordinates(component, at, order=1, mode="nearest") for component in gradient])
        norm_sq = np.maximum((g * g).sum(axis=0), 1e-12)
        move = np.clip(0.5 - value, -0.04, 0.04) * g / norm_sq
        p[:, active] = at + move / metric[:, None]
        active = active[np.abs(value - 0.5) > 1e-3]
        if active.size == 0:
            break
    return p[0], p[1]


def extraction(amplitude):
    """What scipy offers for horizon candidates: the nearest extremum of every voxel and connected extrema; no triangles, no trees."""
    from scipy.ndimage import distance_transform_edt, label

    middle = amplitude[:, :, 1:-1]
    peak = (middle > 0) & (middle > amplitude[:, :, :-2]) & (middle >= amplitude[:, :, 2:])
    trough = (middle < 0) & (middle < amplitude[:, :, :-2]) & (middle <= amplitude[:, :, 2:])
    extrema = np.zeros(amplitude.shape, bool)
    extrema[:, :, 1:-1] = peak | trough
    started = time.perf_counter()
    distance_transform_edt(~extrema, return_indices=True)
    transformed = time.perf_counter()
    label(extrema, structure=np.ones((3, 3, 3)))
    return {
        "scipy_distance_s": round(transformed - started, 2),
        "scipy_label_s": round(time.perf_counter() - transformed, 2),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dir", type=pathlib.Path)
    parser.add_argument("--scipy", action="store_true", help="time scipy's cKDTree too (minutes)")
    args = parser.parse_args()
    meta = json.loads((args.dir / "meta.json").read_text())
    region, sheets = np.load(args.dir / "region.npy"), np.load(args.dir / "sheets.npy")
    result = {"size": meta["size"], "threads": int(os.environ.get("OMP_NUM_THREADS", "0")) or os.cpu_count()}
    if (args.dir / "amplitude.npy").exists():
        result.update(extraction(np.load(args.dir / "amplitude.npy")))
    started = time.perf_counter()
    k = f_z(region, sheets, meta, pykdtree_distances)
    result["pykdtree_f_z_s"] = round(time.perf_counter() - started, 2)
    started = time.perf_counter()
    trace(k, region, meta)
    result["numpy_trace_s"] = round(time.perf_counter() - started, 2)
    if args.scipy:
        started = time.perf_counter()
        f_z(region, sheets, meta, scipy_distances)
        result["scipy_f_z_s"] = round(time.perf_counter() - started, 2)
    print(json.dumps(result))


if __name__ == "__main__":
    main()
