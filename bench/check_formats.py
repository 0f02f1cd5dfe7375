#!/usr/bin/env python3
"""Reopens in other programs what Petroglyph writes, and compares positions and values; reads the same LAS with both.

    python bench/check_formats.py [PETROGLYPH] [WORK_DIR]

Needs numpy, scipy, xtgeo, segyio and lasio from PyPI. A synthetic survey, a horizon with holes and a well are made; with PETROGLYPH_DATA
also Horizon B of the rotated Penobscot survey is exported. Prints a line per check; exit code 1 when one fails.
"""

import json
import os
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

import lasio
import numpy as np
import segyio
import xtgeo
from scipy.spatial import cKDTree

PROGRAM = Path(sys.argv[1] if len(sys.argv) > 1 else "target/debug/petroglyph").resolve()
FAILED = []
# xtgeo finds milliseconds on the vertical axis of a TSurf uncommon.
warnings.filterwarnings("ignore", message=".*Uncommon AXIS.*")


def run(work, *arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=work, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"petroglyph {' '.join(map(str, arguments))}: {done.stderr}")
    return done.stdout


def answer(work, *arguments):
    return json.loads(run(work, *arguments, "--json"))


def check(what, apart, allowed, unit):
    good = np.isfinite(apart) and apart <= allowed
    print(f"{'ok  ' if good else 'FAIL'} {what}: {apart:.3g} {unit} apart (allowed {allowed:g})")
    if not good:
        FAILED.append(what)


def count(what, found, wanted):
    print(f"{'ok  ' if found == wanted else 'FAIL'} {what}: {found} (expected {wanted})")
    if found != wanted:
        FAILED.append(what)


def surface_points(surface):
    """X, Y, Z of the defined nodes of an xtgeo surface."""
    x, y = surface.get_xy_values()
    known = ~surface.values.mask
    return np.column_stack([a.data[known] if hasattr(a, "data") else a[known] for a in (x, y, surface.values)])


def tsurf_points(path):
    rows = [line.split() for line in open(path) if line.startswith("VRTX")]
    return np.array([[float(v) for v in row[2:5]] for row in rows])


def cps3_points(path):
    """A reader of its own: xtgeo has none for CPS-3."""
    lines = [line.rstrip() for line in open(path)]
    fact = {line.split()[0]: line.split()[1:] for line in lines if line.startswith("FS")}
    x0, x1, y0, y1 = map(float, fact["FSLIMI"][:4])
    rows, columns = map(int, fact["FSNROW"])
    body = " ".join(line for line in lines if not line.startswith(("FS", "->", "!")))
    z = np.array(body.split(), float).reshape(columns, rows)[:, ::-1]
    x, y = np.meshgrid(np.linspace(x0, x1, columns), np.linspace(y0, y1, rows), indexing="ij")
    known = z < 1e29
    return np.column_stack([x[known], y[known], z[known]])


def csv_points(path):
    table = np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8")
    z = next(name for name in table.dtype.names if name in ("twt_ms", "depth_m"))
    return np.column_stack([table["x"], table["y"], table[z]])


def opendtect_points(path):
    table = np.loadtxt(path, comments="#")
    return table[:, [0, 1, 4]]


def same_points(what, found, wanted, xy_m, z):
    """Both sets hold the same points: each has its own nearest partner."""
    count(f"{what}: nodes", len(found), len(wanted))
    apart, partner = cKDTree(wanted[:, :2]).query(found[:, :2])
    count(f"{what}: nodes that share a partner", len(found) - len(np.unique(partner)), 0)
    check(f"{what}: X, Y", apart.max(), xy_m, "m")
    check(f"{what}: values", np.abs(found[:, 2] - wanted[partner, 2]).max(), z, "")


def on_surface(what, found, truth, grid, z):
    """Resampled nodes: bilinear on the lattice of the truth, between the corners of its cell."""
    origin, u, v, count_u, count_v, depth = grid
    node = np.linalg.solve(np.column_stack([u, v]), (found[:, :2] - origin).T).T
    low = np.clip(np.floor(node + 1e-9).astype(int), 0, [count_u - 2, count_v - 2])
    f = node - low
    corner = lambda i, j: depth[low[:, 0] + i, low[:, 1] + j]
    bilinear = (
        corner(0, 0) * (1 - f[:, 0]) * (1 - f[:, 1])
        + corner(1, 0) * f[:, 0] * (1 - f[:, 1])
        + corner(0, 1) * (1 - f[:, 0]) * f[:, 1]
        + corner(1, 1) * f[:, 0] * f[:, 1]
    )
    check(f"{what}: {len(found)} resampled nodes on the bilinear surface", np.nanmax(np.abs(bilinear - found[:, 2])), z, "")


def horizon(work, project, name, label, grid=None):
    """Exports a horizon in all formats; the CSV, read by numpy, is what the others are compared with."""
    out = lambda extension: Path(work) / f"{label}.{extension}"
    for fmt, extension in [
        ("csv", "csv"),
        ("irap", "irap"),
        ("zmap", "zmap"),
        ("cps3", "cps3"),
        ("tsurf", "ts"),
        ("opendtect", "dat"),
    ]:
        run(work, "export", project, out(extension), "--horizon", name, "--format", fmt)
    truth = csv_points(out("csv"))
    irap = xtgeo.surface_from_file(out("irap"), fformat="irap_ascii")
    # Irap holds right angles alone; the survey's, from coordinates rounded to centimetres, is off by a millionth.
    same_points(f"{label} irap by xtgeo", surface_points(irap), truth, 1e-3 if grid is None else 1e-2, 1e-3)
    # Two decimals in X and in Y.
    same_points(f"{label} opendtect by numpy", opendtect_points(out("dat")), truth, 7.1e-3, 1e-3)
    vertices = tsurf_points(out("ts"))
    same_points(f"{label} tsurf", vertices, truth, 1e-3, 1e-3)
    read = xtgeo.triangulated_surface_from_file(out("ts"), fformat="tsurf")
    same_points(f"{label} tsurf by xtgeo", np.asarray(read.vertices), vertices, 1e-6, 1e-6)
    zmap = surface_points(xtgeo.surface_from_file(out("zmap"), fformat="zmap_ascii"))
    cps3 = cps3_points(out("cps3"))
    if grid is None:
        same_points(f"{label} zmap by xtgeo", zmap, truth, 1e-3, 1e-3)
        same_points(f"{label} cps3", cps3, truth, 1e-3, 1e-3)
    else:
        on_surface(f"{label} zmap by xtgeo", zmap, truth, grid, 2e-3)
        on_surface(f"{label} cps3", cps3, truth, grid, 2e-3)
        same_points(f"{label} cps3 and zmap", cps3, zmap, 1e-3, 1e-3)


def segy(work):
    path = Path(work) / "s/survey.sgy"
    info = answer(work, "info", path)
    with segyio.open(path) as f:
        for axis, lines in (("inlines", f.ilines), ("crosslines", f.xlines)):
            said = info[axis]
            ours = range(said["first"], said["last"] + said["step"], said["step"])
            count(f"segy {axis}: {ours[0]} to {ours[-1]}, lines that differ", sum(a != b for a, b in zip(lines, ours)), 0)
            count(f"segy {axis}", len(lines), len(ours))
        count("segy samples", len(f.samples), info["samples"])
        scalar = -1.0 / f.header[0][segyio.TraceField.SourceGroupScalar]
        geometry = info["geometry"]
        a, b, o = (np.array(geometry[k]) for k in ("inline_vector", "crossline_vector", "origin"))
        worst = 0.0
        for n in range(0, f.tracecount, max(1, f.tracecount // 500)):
            header = f.header[n]
            i = (header[segyio.TraceField.INLINE_3D] - info["inlines"]["first"]) / info["inlines"]["step"]
            j = (header[segyio.TraceField.CROSSLINE_3D] - info["crosslines"]["first"]) / info["crosslines"]["step"]
            xy = scalar * np.array([header[segyio.TraceField.CDP_X], header[segyio.TraceField.CDP_Y]])
            worst = max(worst, np.abs(o + i * a + j * b - xy).max())
        # Coordinates in trace headers are whole multiples of the scalar.
        check("segy trace positions by segyio", worst, max(1e-3, abs(scalar)), "m")


def well(work):
    md = np.array([0.0, 300.0, 600.0, 900.0, 1200.0, 1800.0])
    inc = np.array([0.0, 0.0, 15.0, 30.0, 45.0, 45.0])
    azi = np.array([0.0, 40.0, 40.0, 55.0, 70.0, 70.0])
    head = np.array(answer(work, "info", "p.petro")["geometry"]["origin"]) + 300.0
    rows = "\n".join(f"{m},{i},{a}" for m, i, a in zip(md, inc, azi))
    (Path(work) / "well.csv").write_text(f"# head_x: {head[0]}\n# head_y: {head[1]}\n# kb: 25\nmd_m,inc,azi\n{rows}\n")
    las = lasio.LASFile()
    las.well.WELL.value = "A-1"
    depth_ft = np.arange(400.0, 1700.0, 0.5) / 0.3048
    gamma = 60 + 30 * np.sin(depth_ft / 40)
    gamma[100:140] = np.nan
    las.append_curve("DEPT", depth_ft, unit="FT", descr="measured depth")
    las.append_curve("GR", gamma, unit="GAPI", descr="gamma ray")
    las.append_curve("DT", 300 - depth_ft / 50, unit="US/F", descr="sonic")
    for wrap in (False, True):
        name = f"A-1{' wrapped' if wrap else ''}"
        path = Path(work) / f"{name}.las"
        with open(path, "w") as f:
            las.write(f, version=2.0, wrap=wrap, fmt="%.6f")
        run(work, "well", "add", "p.petro", "well.csv", "--name", name, "--las", path)
        stored = next((Path(work) / "p.petro/wells").glob(f"{name.replace(' ', '_')}*.json"))
        ours = json.loads(stored.read_text())["well"]["logs"][0]
        again = lasio.read(path)
        check(f"las {name}: depths by lasio", np.abs(np.array(ours["md_m"]) - again.index * 0.3048).max(), 1e-6, "m")
        for curve in ours["curves"]:
            values = np.array([np.nan if v is None else v for v in curve["values"]])
            theirs = again[curve["name"]]
            count(f"las {name}: {curve['name']} holes", int(np.isnan(values).sum()), int(np.isnan(theirs).sum()))
            check(f"las {name}: {curve['name']}", np.nanmax(np.abs(values - theirs)), 1e-4, curve["unit"])
    # Minimum curvature once more, in numpy.
    place = np.array([*head, -25.0])
    tangent = lambda i, a: np.array([np.sin(i) * np.sin(a), np.sin(i) * np.cos(a), np.cos(i)])
    stations = answer(work, "well", "show", "p.petro", "A-1")["stations"]
    worst = 0.0
    for n in range(1, len(md)):
        t0, t1 = (tangent(*np.radians([inc[k], azi[k]])) for k in (n - 1, n))
        beta = np.arccos(np.clip(t0 @ t1, -1, 1))
        ratio = 1.0 if beta < 1e-9 else 2 / beta * np.tan(beta / 2)
        place = place + (md[n] - md[n - 1]) / 2 * (t0 + t1) * ratio
        worst = max(worst, np.abs(place - np.array(stations[n]["position"])).max())
    check("well stations by numpy", worst, 1e-6, "m")


def penobscot(work):
    data = Path(os.environ["PETROGLYPH_DATA"])
    volume = next((data / "volumes").glob("penobscot*.sgy"))
    run(work, "import", volume, "penobscot.petro")
    run(work, "horizon", "add", "penobscot.petro", data / "interpretation/penobscot_horizon_B/truth_il_xl_x_y_twt.csv", "--name", "B")
    info = answer(work, "info", "penobscot.petro")
    geometry = info["geometry"]
    origin, u, v = (np.array(geometry[k]) for k in ("origin", "inline_vector", "crossline_vector"))
    truth = np.loadtxt(data / "interpretation/penobscot_horizon_B/truth_il_xl_x_y_twt.csv", delimiter=",", skiprows=1)
    counts = info["inlines"]["count"], info["crosslines"]["count"]
    depth = np.full(counts, np.nan)
    depth[truth[:, 0].astype(int) - info["inlines"]["first"], truth[:, 1].astype(int) - info["crosslines"]["first"]] = truth[:, 4]
    horizon(work, "penobscot.petro", "B", "penobscot", (origin, u, v, *counts, depth))


def main():
    folder = tempfile.TemporaryDirectory() if len(sys.argv) < 3 else None
    work = folder.name if folder else sys.argv[2]
    run(work, "synth", "s", "--size", "64x48x64", "--seed", "5")
    run(work, "import", "s/survey.sgy", "p.petro")
    segy(work)
    # An unrotated survey of one's own, with holes.
    run(work, "create", "c.petro", "--bounds", "1000,3000,5000,6000,0,1000", "--size", "81x51x101")
    i, j = np.meshgrid(np.arange(81), np.arange(51), indexing="ij")
    z = 400 + 2.5 * i - 1.5 * j + 20 * np.sin(i / 9)
    keep = (i - 30) ** 2 + (j - 20) ** 2 > 60
    rows = np.column_stack([1000 + 25 * i[keep], 5000 + 20 * j[keep], z[keep]])
    np.savetxt(Path(work) / "holes.csv", rows, delimiter=",", header="x,y,depth_m", comments="", fmt="%.4f")
    run(work, "horizon", "add", "c.petro", "holes.csv", "--name", "Holes")
    horizon(work, "c.petro", "Holes", "unrotated")
    well(work)
    if "PETROGLYPH_DATA" in os.environ:
        penobscot(work)
    else:
        print("     PETROGLYPH_DATA is not set: nothing rotated was compared")
    print(f"{len(FAILED)} failed" if FAILED else "all hold")
    sys.exit(bool(FAILED))


main()
