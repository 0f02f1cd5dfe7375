#!/usr/bin/env python3
"""Times the Python side on the input that `petroglyph bench --dump DIR` wrote: the parameterization, and with --store the store, with --segy reading SEG-Y, with --volume
pictures of a volume.

    python3 -m venv venv && venv/bin/pip install numpy scipy pykdtree segyio multidimio
    petroglyph bench --dump DIR
    OMP_NUM_THREADS=2 venv/bin/python bench/peers.py DIR [--scipy]
    venv/bin/python bench/peers.py DIR --store

With --store: segyio reads `survey.sgy` (cube, inline, crossline, depth slice; the page cache is warm) and MDIO ingests it with its own
template for post-stack volumes and its default chunks and codec, then reads the same three sections; the shortest of seven counts.

    venv/bin/pip install vtk
    cargo run -p render --example volume_speed -- --dump volume.raw
    venv/bin/python bench/peers.py --volume volume.raw [--side 256 --pixels 800 --function typical]

times VTK's volume mappers on the volume, function, camera and step that `volume_speed` draws: one sample a voxel, the white ramp, a parallel
projection over a corner. VTK's graphics mapper runs on whatever OpenGL there is, without a window.

    cargo run -p candidates --example extraction_speed -- 256 1 amplitude.npy
    venv/bin/python bench/peers.py --amplitude amplitude.npy

times scipy's nearest extrema and connected extrema on the samples that our extraction was timed on.

Input (all written by the dump): `region.npy` uint16 [inline][crossline][sample], layer + layers * block; `sheets.npy`
float32 [horizon][block][x][y], voxel z of the extended sheets; `meta.json` with `size`, `margin` (nodes around the
survey), `metric_m` (m per voxel along x, y, z), `layers`, `blocks`; `amplitude.npy` float32 [inline][crossline][sample], the synthetic
survey that horizon candidates are extracted from. Only closed layers (two horizons) are timed on both sides.

With --segy, DIR is instead the folder of `petroglyph bench --segy DIR`, and segyio reads the same cubes:

    venv/bin/pip install segyio
    petroglyph bench --segy DIR
    venv/bin/python bench/peers.py --segy DIR

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


def read_segy(folder, rounds=5):
    """GB/s at which segyio's own whole-cube reading fills an array, the quickest of several rounds."""
    import importlib.metadata

    import segyio

    result = {"segyio": importlib.metadata.version("segyio")}
    for name in ("ieee", "ibm"):
        seconds = []
        for _ in range(rounds):
            started = time.perf_counter()
            cube = segyio.tools.cube(str(folder / f"{name}.sgy"))
            seconds.append(time.perf_counter() - started)
        result[f"{name}_gb_per_s"] = round(cube.nbytes / 1e9 / min(seconds), 2)
        result[f"{name}_s"] = [round(s, 3) for s in seconds]
        del cube
    return result


def extraction(amplitude):
    """What scipy offers for horizon candidates: the nearest extremum of every voxel and connected extrema; no triangles, no trees."""
    from scipy.ndimage import distance_transform_edt, label

    middle = amplitude[:, :, 1:-1]
    peak = (middle > 0) & (middle > amplitude[:, :, :-2]) & (middle >= amplitude[:, :, 2:])
    trough = (middle < 0) & (middle < amplitude[:, :, :-2]) & (middle <= amplitude[:, :, 2:])
    extrema = np.zeros(amplitude.shape, bool)
    extrema[:, :, 1:-1] = peak | trough
    started, busy = time.perf_counter(), processor_seconds()
    distance_transform_edt(~extrema, return_indices=True)
    transformed = time.perf_counter()
    label(extrema, structure=np.ones((3, 3, 3)))
    return {
        "scipy_distance_s": round(transformed - started, 2),
        "scipy_label_s": round(time.perf_counter() - transformed, 2),
        "scipy_processor_s": round(processor_seconds() - busy, 2),
    }


FUNCTIONS = {
    "dense": [(-1.3, 0.002), (1.3, 0.02)],
    "typical": [(-1.3, 0.0), (0.13, 0.0), (1.3, 1.0)],
    "sparse": [(-1.3, 0.0), (1.04, 0.0), (1.3, 1.0)],
}


def processor_seconds():
    times = os.times()
    return times.user + times.system


def vtk_picture(path, side, pixels, function, mapper, shade, reach, out=None):
    """Seconds of the clock and of the processor for a picture, the best of three after a first."""
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk

    values = np.fromfile(path, np.float32).reshape(side, side, side)
    # VTK wants x fastest; ours are z fastest.
    scalars = numpy_to_vtk(np.ascontiguousarray(values.transpose(2, 1, 0)).ravel(), deep=True)
    image = vtk.vtkImageData()
    image.SetDimensions(side, side, side)
    image.GetPointData().SetScalars(scalars)
    opacity, colour = vtk.vtkPiecewiseFunction(), vtk.vtkColorTransferFunction()
    for value, alpha in FUNCTIONS[function]:
        opacity.AddPoint(value, alpha)
    colour.AddRGBPoint(-1.3, 1, 1, 1)
    colour.AddRGBPoint(1.3, 1, 1, 1)
    look = vtk.vtkVolumeProperty()
    look.SetScalarOpacity(opacity)
    look.SetColor(colour)
    look.SetInterpolationTypeToLinear()
    look.SetScalarOpacityUnitDistance(1.0)
    if shade:
        look.ShadeOn()
    if mapper == "gpu":
        drawer = vtk.vtkOpenGLGPUVolumeRayCastMapper()
        drawer.SetSampleDistance(1.0)
        if reach is not None:
            drawer.SetVolumetricScatteringBlending(2.0)
            drawer.SetGlobalIlluminationReach(reach)
    else:
        drawer = vtk.vtkFixedPointVolumeRayCastMapper()
        drawer.SetSampleDistance(1.0)
        drawer.SetInteractiveSampleDistance(1.0)
        drawer.SetImageSampleDistance(1.0)
    drawer.SetAutoAdjustSampleDistances(0)
    drawer.SetInputData(image)
    volume = vtk.vtkVolume()
    volume.SetMapper(drawer)
    volume.SetProperty(look)
    renderer = vtk.vtkRenderer()
    renderer.AddVolume(volume)
    camera = renderer.GetActiveCamera()
    azimuth, elevation = np.radians(35.0), np.radians(28.0)
    # x east, y north, and z down in the volume: seen with z pointing down.
    forward = np.array([np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation)])
    middle = np.full(3, (side - 1) / 2)
    camera.SetFocalPoint(*middle)
    camera.SetPosition(*(middle - forward * side * 3))
    camera.SetViewUp(0, 0, -1)
    camera.ParallelProjectionOn()
    right = np.array([np.cos(azimuth), -np.sin(azimuth), 0.0])
    up = np.cross(forward, right)
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * (side - 1) - middle
    widest = max(np.ptp(corners @ right), np.ptp(corners @ up))
    # The picture's half height in the volume's units, with the same free border of 4 % to each side.
    camera.SetParallelScale(widest / 2 / 0.92)
    renderer.ResetCameraClippingRange()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(pixels, pixels)
    window.AddRenderer(renderer)
    wall, spent = [], []
    for _ in range(4):
        volume.Modified()
        began, before = time.perf_counter(), processor_seconds()
        window.Render()
        grab = vtk.vtkWindowToImageFilter()
        grab.SetInput(window)
        grab.ReadFrontBufferOff()
        grab.Update()
        wall.append(time.perf_counter() - began)
        spent.append(processor_seconds() - before)
    if out:
        writer = vtk.vtkPNGWriter()
        writer.SetFileName(out)
        writer.SetInputConnection(grab.GetOutputPort())
        writer.Write()
    return min(wall[1:]), min(spent[1:])


def time_vtk(args):
    rows = [("cpu ray caster", "cpu", False, None), ("cpu ray caster, Phong", "cpu", True, None), ("gpu mapper", "gpu", False, None), ("gpu mapper, Phong", "gpu", True, None),
            ("gpu mapper, scattering, reach 0", "gpu", True, 0.0), ("gpu mapper, scattering, reach 0.3", "gpu", True, 0.3)]
    for n, (name, mapper, shade, reach) in enumerate(rows):
        out = f"{args.keep}/vtk-{n}.png" if args.keep else None
        wall, spent = vtk_picture(args.volume, args.side, args.pixels, args.function, mapper, shade, reach, out)
        print(f"VTK {name:<36} {args.function:<8} {wall:8.3f} s  {spent:7.2f} s of processor", flush=True)


def shortest_ms(read, repeats=7):
    """Milliseconds of the fastest of some reads."""
    took = []
    for _ in range(repeats):
        started = time.perf_counter()
        read()
        took.append(time.perf_counter() - started)
    return round(min(took) * 1e3, 3)


def time_segyio(path):
    import segyio

    started = time.perf_counter()
    segyio.tools.cube(str(path))
    result = {"cube_s": round(time.perf_counter() - started, 2)}
    with segyio.open(str(path)) as file:
        inline, crossline = file.ilines[len(file.ilines) // 2], file.xlines[len(file.xlines) // 2]
        result["inline_ms"] = shortest_ms(lambda: file.iline[inline])
        result["crossline_ms"] = shortest_ms(lambda: file.xline[crossline])
        result["slice_ms"] = shortest_ms(lambda: file.depth_slice[len(file.samples) // 2], 3)
    return result


def time_mdio(path, out):
    import shutil

    from mdio import open_mdio, segy_to_mdio
    from mdio.builder.template_registry import TemplateRegistry
    from segy.schema import HeaderField
    from segy.standards import get_segy_standard

    places = {"inline": 189, "crossline": 193, "cdp_x": 181, "cdp_y": 185}
    fields = [HeaderField(name=name, byte=byte, format="int32") for name, byte in places.items()]
    spec = get_segy_standard(1.0).customize(trace_header_fields=fields)
    template = TemplateRegistry.get_instance().get("PostStack3DTime")
    shutil.rmtree(out, ignore_errors=True)
    started = time.perf_counter()
    segy_to_mdio(segy_spec=spec, mdio_template=template, input_path=str(path), output_path=str(out), overwrite=True)
    took = time.perf_counter() - started
    volume = open_mdio(str(out))["amplitude"]
    n = volume.shape[0] // 2
    return {
        "ingest_s": round(took, 2),
        "ingest_mb_s": round(volume.size * 4 / took / 1e6, 1),
        "inline_ms": shortest_ms(lambda: volume[n].values),
        "crossline_ms": shortest_ms(lambda: volume[:, n].values),
        "slice_ms": shortest_ms(lambda: volume[:, :, n].values),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dir", type=pathlib.Path, nargs="?")
    parser.add_argument("--volume", help="raw floats to time VTK on, as `volume_speed --dump` writes them")
    parser.add_argument("--side", type=int, default=256)
    parser.add_argument("--pixels", type=int, default=800)
    parser.add_argument("--function", choices=FUNCTIONS, default="typical")
    parser.add_argument("--keep", help="folder for VTK's pictures")
    parser.add_argument("--scipy", action="store_true", help="time scipy's cKDTree too (minutes)")
    parser.add_argument("--segy", action="store_true", help="time segyio on the cubes of `petroglyph bench --segy DIR`")
    parser.add_argument("--amplitude", metavar="FILE", help="time scipy's extraction on the samples of this .npy instead")
    parser.add_argument("--store", action="store_true", help="time segyio and MDIO on survey.sgy instead")
    args = parser.parse_args()
    if args.segy:
        print(json.dumps(read_segy(args.dir)))
        return
    if args.volume:
        time_vtk(args)
        return
    if args.amplitude:
        print(json.dumps(extraction(np.load(args.amplitude))))
        return
    if args.dir is None:
        parser.error("DIR or --volume is needed")
    if args.store:
        survey = args.dir / "survey.sgy"
        print(json.dumps({"segyio": time_segyio(survey), "mdio": time_mdio(survey, args.dir / "survey.mdio")}))
        return
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
