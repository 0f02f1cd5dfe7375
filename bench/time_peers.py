#!/usr/bin/env python3
"""Relative geologic time by published means, on the volume that our own was measured on, for docs/time.md.

    python3 -m venv venv && venv/bin/pip install numpy scipy pyseistr
    cargo run -p time --example isochrons 128 3 1 --dump volume.f32
    venv/bin/python bench/time_peers.py volume.f32 128 tau.f32 --method tensor
    cargo run -p time --example isochrons 128 3 1 --tau tau.f32

Methods:

tensor    Dips from the structure tensor (Gaussian derivatives, smoothed), weights from its linearity; tau is the least-squares
          solution of  w (d tau/dx + p d tau/dz) = 0,  w (d tau/dy + q d tau/dz) = 0,  e (d tau/dz - 1) = 0  by conjugate
          gradients (after Lomask and others 2006, Wu and Hale 2015, without constraints). No faults: neither knows of any.
pwd       The same system with dips of plane-wave destruction from pyseistr (Fomel 2002), with weights of one.
paint     pyseistr alone: predictive painting (Fomel 2010) of tau along those dips, from the middle trace along the middle inline,
          and from that inline along every crossline.

pyseistr 0.0.4 builds with numpy below 2.

The volume is float32 [inline][crossline][sample], as is what is written.
"""
import argparse
import time

import numpy as np
from scipy.ndimage import gaussian_filter
from scipy.sparse.linalg import LinearOperator, cg


def tensor_dips(volume):
    """Dips in samples a trace along both axes, and linearity."""
    gradients = [gaussian_filter(volume, 1.0, order=[int(axis == n) for n in range(3)]) for axis in range(3)]
    shape = volume.shape + (3, 3)
    tensor = np.empty(shape, np.float32)
    for a in range(3):
        for b in range(a, 3):
            tensor[..., a, b] = tensor[..., b, a] = gaussian_filter(gradients[a] * gradients[b], (2, 2, 3))
    values, vectors = np.linalg.eigh(tensor)
    normal = vectors[..., 2]
    down = np.where(np.abs(normal[..., 2]) < 0.2, 0.2, normal[..., 2])
    linearity = (values[..., 2] - values[..., 1]) / np.maximum(values[..., 2], 1e-12)
    return np.clip(-normal[..., 0] / down, -4, 4), np.clip(-normal[..., 1] / down, -4, 4), linearity


def destruction_dips(volume):
    """Dips by plane-wave destruction; pyseistr wants [sample][inline][crossline]."""
    import pyseistr

    p, q = pyseistr.dip3dc(np.asfortranarray(volume.transpose(2, 0, 1)), niter=10, rect=[5, 5, 5], verb=0)[:2]
    back = lambda dip: np.ascontiguousarray(dip.reshape(volume.shape[2], *volume.shape[:2]).transpose(1, 2, 0))
    return back(p), back(q), np.ones_like(volume)


def painted(p, q):
    """tau by predictive painting from the middle trace."""
    from pyseistr.rgt import pwpaintc

    nx, ny, nz = p.shape
    paint = lambda dip, trace, middle: np.asarray(
        pwpaintc(np.asfortranarray(dip.T.astype(np.float32)), trace.astype(np.float32), order=2, i0=middle, eps=0.1)
    ).reshape(dip.T.shape).T
    inline = paint(q[nx // 2], np.arange(nz), ny // 2)
    return np.stack([paint(p[:, y], inline[y], nx // 2) for y in range(ny)], axis=1)


def solve(p, q, weight, epsilon, iterations):
    """tau from dips: s = tau - z is solved for."""
    nx, ny, nz = p.shape
    w2 = weight.astype(np.float32) ** 2

    def halves(a, axis):
        return 0.5 * (a.take(range(1, a.shape[axis]), axis) + a.take(range(a.shape[axis] - 1), axis))

    def down(s):
        return np.gradient(s, axis=2)

    def down_transposed(a):
        out = np.zeros_like(a)
        out[..., 2:] += 0.5 * a[..., 1:-1]
        out[..., :-2] -= 0.5 * a[..., 1:-1]
        out[..., 1] += a[..., 0]
        out[..., 0] -= a[..., 0]
        out[..., -1] += a[..., -1]
        out[..., -2] -= a[..., -1]
        return out

    weights = [halves(w2, 0), halves(w2, 1)]
    dips = [halves(p, 0), halves(q, 1)]

    def forward(s, axis):
        return np.diff(s, axis=axis) + dips[axis] * halves(down(s), axis)

    def backward(e, axis):
        out = np.zeros((nx, ny, nz), np.float32)
        upper, lower = [slice(None)] * 3, [slice(None)] * 3
        upper[axis], lower[axis] = slice(1, None), slice(None, -1)
        out[tuple(upper)] += e
        out[tuple(lower)] -= e
        middle = np.zeros((nx, ny, nz), np.float32)
        middle[tuple(upper)] += 0.5 * dips[axis] * e
        middle[tuple(lower)] += 0.5 * dips[axis] * e
        return out + down_transposed(middle)

    def matrix(flat):
        s = flat.reshape(nx, ny, nz).astype(np.float32)
        out = sum(backward(weights[axis] * forward(s, axis), axis) for axis in (0, 1))
        return (out + epsilon * down_transposed(down(s))).ravel()

    right = -sum(backward(weights[axis] * dips[axis], axis) for axis in (0, 1)).ravel()
    size = nx * ny * nz
    operator = LinearOperator((size, size), matvec=matrix, dtype=np.float32)
    s, _ = cg(operator, right, maxiter=iterations, rtol=5e-3)
    return s.reshape(nx, ny, nz) + np.arange(nz, dtype=np.float32)


def main():
    typed = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    typed.add_argument("volume")
    typed.add_argument("side", type=int)
    typed.add_argument("out")
    typed.add_argument("--method", choices=["tensor", "pwd", "paint"], default="tensor")
    typed.add_argument("--iterations", type=int, default=100)
    options = typed.parse_args()
    volume = np.fromfile(options.volume, np.float32).reshape((options.side,) * 3)
    start, cpu = time.perf_counter(), time.process_time()
    p, q, weight = (tensor_dips if options.method == "tensor" else destruction_dips)(volume)
    dips = time.perf_counter() - start
    tau = painted(p, q) if options.method == "paint" else solve(p, q, weight, 1e-2, options.iterations)
    # Monotone, as ours is.
    tau = np.maximum.accumulate(tau, axis=2)
    tau.astype(np.float32).tofile(options.out)
    whole, cpu = time.perf_counter() - start, time.process_time() - cpu
    print(f"{options.method}: dips {dips:.1f} s, all {whole:.1f} s, processor {1e6 * cpu / volume.size:.1f} us a voxel")


if __name__ == "__main__":
    main()
