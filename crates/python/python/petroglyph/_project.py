"""Projects, and what they hold, as arrays and pictures."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Literal

from petroglyph import _native
from petroglyph._calls import run
from petroglyph._commands import Commands, Effect
from petroglyph._errors import PetroglyphError
from petroglyph._folders import beside
from petroglyph._geometry import Geometry
from petroglyph._stored import described, open_volume, write_volume
from petroglyph._types import Options, Path, Progress

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import xarray as xr

#: A value of an option, as :func:`petroglyph.program.run` takes it.
Option = Any

#: What quality numbers of a horizon's nodes mean.
QUALITIES = ("hole", "picked", "tracked", "filled", "extrapolated", "snapped")


class Picture:
    """A picture: pixels for NumPy, and a PNG file for notebooks and disks."""

    def __init__(self, png: bytes, report: Mapping[str, Any]) -> None:
        self._png = png
        #: What the command line reports of the picture: size, assumptions, stages.
        self.report = dict(report)

    def _repr_png_(self) -> bytes:
        return self._png

    def numpy(self) -> npt.NDArray[np.uint8]:
        """The pixels, ``[row][column][red, green, blue, alpha]``."""
        return _native.decode_png(self._png)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        pixels = self.numpy()
        return pixels if dtype is None else pixels.astype(dtype)

    def save(self, path: Path) -> None:
        """Writes the PNG file."""
        FilePath(path).write_bytes(self._png)

    def __repr__(self) -> str:
        width, height = int.from_bytes(self._png[16:20]), int.from_bytes(self._png[20:24])
        return f"<petroglyph.Picture {width} x {height}>"


class Volume:
    """A volume of a project. Indexing reads what is asked for and nothing else.

    Examples
    --------
    >>> volume = project.volume("seismic")      # doctest: +SKIP
    >>> inline = volume[10]                     # doctest: +SKIP
    >>> slice_ = volume[:, :, 250]              # doctest: +SKIP
    """

    def __init__(self, project: Project, name: str) -> None:
        self._native = project._native
        self.name = name
        found = json.loads(self._native.volume_info(name))
        self._levels: list[tuple[int, int, int]] = [tuple(size) for size in found["levels"]]
        #: Quantity, unit, polarity and source, where they are known.
        self.info: dict[str, Any] = found["info"]
        #: Type of the samples, as NumPy names it.
        self.dtype_name: str = found["dtype"]
        #: Number of recorded traces.
        self.live_traces: int = found["live_traces"]

    @property
    def shape(self) -> tuple[int, int, int]:
        """Counts of inlines, crosslines and samples."""
        return self._levels[0]

    @property
    def level_count(self) -> int:
        """Levels of the pyramid, the full volume included."""
        return len(self._levels)

    @property
    def geometry(self) -> Geometry:
        """Its lattice."""
        return Geometry.from_dict(self.info["geometry"])

    @property
    def path(self) -> FilePath:
        """The folder that it is stored in, a Zarr v3 group."""
        return FilePath(self._native.volume_path(self.name))

    def numpy(self, level: int = 0, progress: Progress | None = None) -> npt.NDArray[Any]:
        """All samples of a level; each level has half the samples of the one before along each axis.

        The array is the memory that the samples were read into: nothing is copied.
        """
        if not 0 <= level < len(self._levels):
            raise PetroglyphError(
                f"volume {self.name!r} has no level {level}", f"its levels are 0 to {len(self._levels) - 1}"
            )
        return self._native.read_box(self.name, level, (0, 0, 0), self._levels[level], progress)

    def live(self) -> npt.NDArray[np.bool_]:
        """Which traces were recorded, ``[inline][crossline]``."""
        return self._native.read_live(self.name)

    def xarray(self, *, chunks: Mapping[str, int] | str | None = None) -> xr.DataArray:
        """The volume as a labelled array, read when it is used; see :func:`petroglyph.open_volume`."""
        return open_volume(self.path, chunks=chunks).rename(self.name)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        samples = self.numpy()
        return samples if dtype is None else samples.astype(dtype)

    def __getitem__(self, index: Any) -> npt.NDArray[Any]:
        index = index if isinstance(index, tuple) else (index,)
        if len(index) > 3 or any(not isinstance(part, (int, slice)) and part is not Ellipsis for part in index):
            raise PetroglyphError("a volume is indexed by whole numbers and ranges", "read it by numpy() for other ways")
        if Ellipsis in index:
            at = index.index(Ellipsis)
            index = (*index[:at], *[slice(None)] * (4 - len(index)), *index[at + 1 :])
        index = (*index, *[slice(None)] * (3 - len(index)))
        start: list[int] = []
        size: list[int] = []
        kept: list[int | slice] = []
        for part, count in zip(index, self.shape, strict=True):
            if isinstance(part, int):
                if not -count <= part < count:
                    raise IndexError(f"index {part} is out of bounds for an axis of {count}")
                first, length = part % count, 1
                kept.append(0)
            else:
                first, stop, step = part.indices(count)
                if step < 1:
                    raise PetroglyphError("ranges of a volume go forwards", "turn the array around afterwards")
                length = max(stop - first, 0)
                kept.append(slice(None, None, step))
            start.append(first)
            size.append(length)
        if 0 in size:
            import numpy as np

            return np.empty([n for n, part in zip(size, kept, strict=True) if part != 0], dtype=self.dtype_name)
        read = self._native.read_box(self.name, 0, (start[0], start[1], start[2]), (size[0], size[1], size[2]))
        found: npt.NDArray[Any] = read[tuple(kept)]
        return found

    def __repr__(self) -> str:
        return f"<petroglyph.Volume {self.name!r} {' x '.join(map(str, self.shape))} {self.dtype_name}>"


class Horizon:
    """A horizon of a project: a sheet for each fault block, or a surface of any shape."""

    def __init__(self, project: Project, name: str) -> None:
        self.name = name
        sheets, self._surface = project._native.horizon(name)
        self._geometry = project.geometry
        self._sheets = [(block, json.loads(grid), depth, quality) for block, grid, depth, quality in sheets]

    @property
    def blocks(self) -> list[int | None]:
        """The fault block of each sheet; ``None``: of all blocks."""
        return [sheet[0] for sheet in self._sheets]

    def numpy(self) -> npt.NDArray[np.float32]:
        """Depths ``[sheet][inline][crossline]`` in the survey's vertical unit, NaN where there is none.

        Sheets on grids of different sizes cannot be one array; :meth:`sheet` gives each.
        """
        import numpy as np

        shapes = {depth.shape for _, _, depth, _ in self._sheets}
        if len(shapes) != 1:
            raise PetroglyphError(
                f"horizon {self.name!r} has {len(self._sheets)} sheets of {len(shapes)} sizes",
                "read them one by one with sheet(n), or its surface() where it has any shape",
            )
        return np.stack([depth for _, _, depth, _ in self._sheets])

    def sheet(self, n: int = 0) -> npt.NDArray[np.float32]:
        """Depths of a sheet, in the memory that they were read into."""
        return self._sheets[n][2]

    def quality(self, n: int = 0) -> npt.NDArray[np.uint8]:
        """How each node of a sheet came about: a position among :data:`QUALITIES`."""
        return self._sheets[n][3]

    def xarray(self, n: int = 0) -> xr.DataArray:
        """A sheet as a labelled array on its own grid, with its quality as a coordinate."""
        import numpy as np
        import xarray as xr

        _, grid, depth, quality = self._sheets[n]
        u, v = np.meshgrid(np.arange(depth.shape[0]), np.arange(depth.shape[1]), indexing="ij")

        def place(axis: int) -> Any:
            return grid["origin"][axis] + grid["u_step"][axis] * u + grid["v_step"][axis] * v

        geometry = self._geometry
        coordinates: dict[str, Any] = {
            "cdp_x": (("inline", "crossline"), place(0)),
            "cdp_y": (("inline", "crossline"), place(1)),
            "quality": (("inline", "crossline"), quality),
        }
        if depth.shape == geometry.shape[:2] and np.allclose(grid["origin"], geometry.origin):
            lines = geometry.coordinates()
            coordinates.update(inline=lines["inline"], crossline=lines["crossline"])
        attributes = {"units": geometry.unit, "positive": "down"}
        return xr.DataArray(depth, coordinates, ("inline", "crossline"), self.name, attributes)

    def surface(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.uint32]] | None:
        """Vertices in world coordinates and triangles, of a horizon of any shape."""
        return self._surface

    def __repr__(self) -> str:
        return f"<petroglyph.Horizon {self.name!r}, {len(self._sheets)} sheets>"


class Fault:
    """A fault of a project: a triangulated surface."""

    def __init__(self, project: Project, name: str) -> None:
        self.name = name
        #: World X, Y and vertical value of each vertex.
        self.vertices: npt.NDArray[np.float64]
        #: Numbers of the three vertices of each triangle.
        self.triangles: npt.NDArray[np.uint32]
        self.vertices, self.triangles = project._native.fault(name)

    def xarray(self) -> xr.Dataset:
        """The surface as a dataset of vertices and triangles."""
        import xarray as xr

        data = {"vertices": (("vertex", "axis"), self.vertices), "triangles": (("triangle", "corner"), self.triangles)}
        return xr.Dataset(data, {"axis": ["x", "y", "z"]}, {"name": self.name})

    def __repr__(self) -> str:
        return f"<petroglyph.Fault {self.name!r}, {len(self.triangles)} triangles>"


class Project(Commands):
    """An open project. Every change is a command, which can be undone.

    Make one with :func:`petroglyph.open`, :func:`petroglyph.create` or :func:`petroglyph.import_segy`.
    """

    def __init__(self, native: _native.Project) -> None:
        self._native = native

    # What it is.

    @property
    def path(self) -> FilePath:
        """The folder."""
        return FilePath(self._native.root)

    @property
    def document(self) -> dict[str, Any]:
        """The state: what ``project.toml`` says."""
        state: dict[str, Any] = json.loads(self._native.document())
        return state

    @property
    def geometry(self) -> Geometry:
        """The lattice of the survey."""
        return Geometry.from_dict(json.loads(self._native.geometry()))

    def _names(self, kind: str) -> list[str]:
        return [entry["name"] for entry in self.document.get(kind, [])]

    @property
    def volumes(self) -> list[str]:
        """Names of the volumes."""
        return self._names("volumes")

    @property
    def horizons(self) -> list[str]:
        """Names of the horizons, youngest first."""
        return self._names("horizons")

    @property
    def faults(self) -> list[str]:
        """Names of the faults."""
        return self._names("faults")

    @property
    def wells(self) -> list[str]:
        """Names of the wells."""
        return self._names("wells")

    @property
    def scenes(self) -> list[str]:
        """Names of the scenes."""
        return self._names("scenes")

    @property
    def layers(self) -> list[str]:
        """Names of the layers between the horizons, from the top down."""
        return self._native.layers()

    @property
    def origins(self) -> dict[str, dict[str, dict[str, Any]]]:
        """Where everything came from, by kind (``"horizons"``) and name: ``kind`` and what belongs to it."""
        found: dict[str, list[dict[str, Any]]] = json.loads(self._native.origins())
        return {kind: {one["name"]: one["origin"] for one in all_of_it} for kind, all_of_it in found.items()}

    @property
    def history(self) -> list[dict[str, Any]]:
        """The steps, oldest first: ``step``, ``summary``, ``in_effect``."""
        steps: list[dict[str, Any]] = json.loads(self._native.history())
        return steps

    def reload(self) -> None:
        """Reads the state again, after another process has changed the project."""
        self._native.reload()

    # What changes it.

    def apply(
        self,
        command: Mapping[str, Any],
        *,
        memory: int | None = None,
        progress: Progress | None = None,
        _moved: bool = False,
    ) -> Effect:
        """Carries out a command and saves the project; on failure it stays as it was.

        Parameters
        ----------
        command : mapping
            The command by its name, with its fields: ``{"set-velocity": {"velocity_m_s": 2500.0}}``.
        memory : int, optional
            Memory to use, bytes, for commands that work brick by brick.
        progress : callable, optional
            Called as ``progress(stage, done, total)``; what it raises cancels the command, as Ctrl-C does.

        Returns
        -------
        dict
            What was done: the object of ``--json``, and ``text``, the words of the command line.

        Raises
        ------
        PetroglyphError
            With the sentence and the hint of the command line.
        """
        effect, text = self._native.apply(json.dumps(command), memory, _moved, progress)
        done: dict[str, Any] = json.loads(effect)
        return {**done, "text": text}

    def undo(self) -> str:
        """Undoes the last command; returns what was undone."""
        return self._native.undo()

    def redo(self) -> str:
        """Redoes the command that was undone last; returns what was redone."""
        return self._native.redo()

    def add_volume(
        self,
        name: str,
        array: Any,
        *,
        geometry: Geometry | None = None,
        live: npt.NDArray[np.bool_] | None = None,
        quantity: str | None = None,
        unit: str | None = None,
        memory: int | None = None,
        progress: Progress | None = None,
    ) -> Effect:
        """Stores an array as a volume of the project.

        Parameters
        ----------
        name : str
            Name of the volume.
        array : array_like
            ``[inline][crossline][sample]``; an :class:`xarray.DataArray` with coordinates lies where they say.
        geometry : Geometry, optional
            The lattice; by default that of the coordinates, or else that of the project.
        live : array_like of bool, optional
            Which traces were recorded.
        quantity, unit : str, optional
            What was measured.
        memory : int, optional
            Memory to use, bytes.
        progress : callable, optional
            Called as ``progress(stage, done, total)``.
        """
        if geometry is None:
            own = self.geometry
            there = described(array, None, live)[1] if hasattr(array, "coords") else own
            # Places that were computed differ in their last digits.
            geometry = own if there.is_close(own) else there
        with beside(self.path) as folder:
            made = os.path.join(folder, "volume.zarr")
            write_volume(
                made, array, geometry=geometry, live=live, quantity=quantity, unit=unit, source="an array of Python",
                memory=memory, progress=progress,
            )  # fmt: skip
            return self.apply({"import": {"path": made, "name": name, "origin": {"kind": "array"}}}, progress=progress, _moved=True)

    def add_horizon_array(self, name: str, depth: Any, **more: Any) -> Effect:
        """Adds a horizon from depths at the traces of the survey.

        Parameters
        ----------
        name : str
            Name of the horizon.
        depth : array_like or xarray.DataArray
            ``[inline][crossline]`` in the survey's vertical unit, NaN where there is none; a labelled array is placed by
            its line numbers.
        **more
            As of :meth:`add_horizon`.
        """
        import numpy as np

        geometry = self.geometry
        if hasattr(depth, "coords"):
            depth = depth.transpose("inline", "crossline")
            inlines, crosslines = (np.asarray(depth.coords[axis].values) for axis in ("inline", "crossline"))
        else:
            lines = geometry.coordinates()
            inlines, crosslines = lines["inline"][1], lines["crossline"][1]
        values = np.asarray(depth, dtype=np.float32)
        if values.shape != (len(inlines), len(crosslines)):
            raise PetroglyphError(
                f"the depths have the shape {values.shape}, the survey {(len(inlines), len(crosslines))} traces",
                "give one depth for each trace, [inline][crossline], or a labelled array",
            )
        column = "twt_ms" if geometry.unit == "ms" else "depth_m"
        with tempfile.TemporaryDirectory() as folder:
            path = FilePath(folder) / f"{_file_name(name)}.csv"
            with path.open("w") as out:
                out.write(f"inline,crossline,{column}\n")
                for x, y in zip(*np.nonzero(np.isfinite(values)), strict=True):
                    out.write(f"{inlines[x]},{crosslines[y]},{values[x, y]!s}\n")
            return self.add_horizon(path, name, **more)

    def add_fault_array(self, name: str, points: Any, triangles: Any = None, **more: Any) -> Effect:
        """Adds a fault from points, or from a triangulated surface.

        Parameters
        ----------
        name : str
            Name of the fault.
        points : array_like
            World X, Y and vertical value of each point, ``[point][3]``.
        triangles : array_like, optional
            Three numbers of points for each triangle; without them a surface is fitted to the points.
        **more
            As of :meth:`add_fault`.
        """
        import numpy as np

        places = np.asarray(points, dtype=float)
        if places.ndim != 2 or places.shape[1] != 3:
            raise PetroglyphError(f"the points have the shape {places.shape}", "give X, Y and Z of each: [point][3]")
        with tempfile.TemporaryDirectory() as folder:
            path = FilePath(folder) / f"{_file_name(name)}.{'csv' if triangles is None else 'ts'}"
            with path.open("w") as out:
                if triangles is None:
                    out.write(f"x,y,{'twt_ms' if self.geometry.unit == 'ms' else 'depth_m'}\n")
                    out.writelines(f"{x!r},{y!r},{z!r}\n" for x, y, z in places.tolist())
                else:
                    out.write("GOCAD TSurf 1\nHEADER {\nname:fault\n}\nTFACE\n")
                    out.writelines(f"VRTX {n + 1} {x!r} {y!r} {z!r}\n" for n, (x, y, z) in enumerate(places.tolist()))
                    corners = np.asarray(triangles, dtype=int) + 1
                    out.writelines(f"TRGL {a} {b} {c}\n" for a, b, c in corners.tolist())
                    out.write("END\n")
            options = dict(more.pop("options", None) or {})
            if triangles is not None:
                options.setdefault("z_unit", self.geometry.unit)
                options.setdefault("z_positive", "down")
            return self.add_fault(path, name, options=options or None, **more)

    # What it holds.

    def volume(self, name: str | None = None) -> Volume:
        """A volume; by default the first."""
        if name is None:
            if not self.volumes:
                raise PetroglyphError("the project has no volume", "import one with import_ or add_volume")
            name = self.volumes[0]
        return Volume(self, name)

    def horizon(self, name: str) -> Horizon:
        """A horizon."""
        return Horizon(self, name)

    def fault(self, name: str) -> Fault:
        """A fault."""
        return Fault(self, name)

    def __iter__(self) -> Iterator[Volume]:
        return (Volume(self, name) for name in self.volumes)

    def parameterization(
        self,
        *,
        size: tuple[int, int, int] | None = None,
        box: tuple[slice, slice, slice] | None = None,
        progress: Progress | None = None,
        threads: int | None = None,
    ) -> xr.Dataset:
        """The layer coordinates i, j, k with the numbers of layer and fault block, at every sample.

        Parameters
        ----------
        size : tuple of int, optional
            Samples along each axis of a lattice that spans the survey; by default those of the survey.
        box : tuple of slice, optional
            A part of that lattice; by default all of it.
        progress : callable, optional
            Called as ``progress(stage, done, total)``.
        threads : int, optional
            Threads to use; by default as many as there are processors.

        Returns
        -------
        xarray.Dataset
            ``i``, ``j``, ``k`` (float32, NaN outside) and ``layer``, ``block`` (uint16, 65535 outside).
        """
        import xarray as xr

        geometry = self.geometry
        size = size or geometry.shape
        ranges = [part.indices(count) for part, count in zip(box or (slice(None),) * 3, size, strict=True)]
        if any(step != 1 or stop <= start for start, stop, step in ranges):
            raise PetroglyphError(f"the box {box} is empty or has steps", "give three ranges without steps")
        start = (ranges[0][0], ranges[1][0], ranges[2][0])
        part = (ranges[0][1] - start[0], ranges[1][1] - start[1], ranges[2][1] - start[2])
        fields, ids = self._native.parameterization(size, start, part, progress, threads)
        axes = ("inline", "crossline", "sample")
        named = zip(("i", "j", "k", "layer", "block"), (*fields, *ids), strict=True)
        data = {name: (axes, values) for name, values in named}
        coordinates: dict[str, Any] = {}
        if size == geometry.shape:
            lines = geometry.coordinates()
            cut = {axis: slice(*bounds) for axis, bounds in zip(axes, ranges, strict=True)}
            for name, (dims, values, attributes) in lines.items():
                coordinates[name] = (dims, values[tuple(cut[dim] for dim in dims)], attributes)
        return xr.Dataset(data, coordinates)

    def render(self, *, progress: Progress | None = None, threads: int | None = None, **options: Option) -> Picture:
        """Draws a picture, by the options of ``petroglyph render``.

        Parameters
        ----------
        progress : callable, optional
            Called as ``progress(stage, done, total)``.
        threads : int, optional
            Threads to use; by default as many as there are processors.
        **options
            ``scene``, ``blend``, ``cut``, ``size``, ``technique``, ``inline``, ``map``, ``legend`` and so on, with ``_`` for
            ``-``; what has no value is given as ``True``, what has several as a list.

        Returns
        -------
        Picture
            It shows itself in a notebook; ``numpy()`` gives the pixels.

        Examples
        --------
        >>> project.render(cut="nearest,0.45,0.45", blend=0.5, size="800x600")     # doctest: +SKIP
        """
        with tempfile.TemporaryDirectory() as folder:
            path = FilePath(folder) / "picture.png"
            report = run("render", self.path, path, progress=progress, threads=threads, **options)
            return Picture(path.read_bytes(), report)

    def figure(self, out: Path, *, progress: Progress | None = None, **options: Option) -> dict[str, Any]:
        """Writes a figure, PNG, TIFF, SVG or PDF by the ending of `out`, by the options of ``petroglyph render``."""
        return run("render", self.path, out, progress=progress, **options)

    def figures(self, out: Path, *, progress: Progress | None = None, **options: Option) -> dict[str, Any]:
        """Makes every figure that the project lists."""
        return run("figures", self.path, out, progress=progress, **options)

    def review(self, out: Path, *, progress: Progress | None = None, **options: Option) -> dict[str, Any]:
        """Writes a page for any browser, by the options of ``petroglyph review``."""
        return run("review", self.path, out, progress=progress, **options)

    def export(self, out: Path, *, progress: Progress | None = None, **options: Option) -> dict[str, Any]:
        """Writes a horizon, a fault, candidates, a volume or a 3D model, by the options of ``petroglyph export``."""
        return run("export", self.path, out, progress=progress, **options)

    def parameterize(self, *, progress: Progress | None = None, **options: Option) -> dict[str, Any]:
        """Computes i, j, k and keeps them in the project, by the options of ``petroglyph parameterize``."""
        done = run("parameterize", self.path, progress=progress, **options)
        self.reload()
        return done

    def check(self, *, repair: bool = False) -> dict[str, Any]:
        """Checks that everything is there and undamaged, and repairs what can be repaired if told to."""
        done = run("check", self.path, repair=repair)
        self.reload()
        return done

    def prune(self) -> None:
        """Deletes the history and the data that only it refers to."""
        run("prune", self.path)
        self.reload()

    def __repr__(self) -> str:
        return f"<petroglyph.Project {os.fspath(self.path)!r}>"


def open(path: Path, *, wait: float = 10.0) -> Project:
    """Opens a project.

    Parameters
    ----------
    path : path
        Its folder.
    wait : float
        Seconds that a change waits while another process is changing the project.
    """
    return Project(_native.Project.open(path, wait))


def create(path: Path, geometry: Geometry | None = None) -> Project:
    """Creates a project without data, with a lattice or without."""
    return Project(_native.Project.create(path, None if geometry is None else geometry.to_json()))


def import_segy(
    survey: Path,
    path: Path,
    *,
    name: str | None = None,
    polarity: Literal["normal", "reverse"] = "normal",
    options: Options | None = None,
    memory: int | None = None,
    progress: Progress | None = None,
) -> Project:
    """Reads a SEG-Y file into a project, which is made if it does not exist.

    Parameters
    ----------
    survey : path
        The file, or the folder of a stored volume.
    path : path
        Folder of the project.
    name, polarity, options, memory, progress
        As of :meth:`Project.import_`.
    """
    if FilePath(path).exists():
        project = open(path)
        project.import_(survey, name=name, polarity=polarity, options=options, memory=memory, progress=progress)
        return project
    fields = {"path": os.fspath(survey), "name": name, "polarity": polarity, "options": options}
    command = json.dumps({"import": {field: value for field, value in fields.items() if value is not None}})
    return Project(_native.Project.create(path, None, [command], memory, False, progress))


def import_volume(array: Any, path: Path, *, name: str = "seismic", **more: Any) -> Project:
    """Makes a project of an array; `more` is as of :meth:`Project.add_volume`."""
    with beside(path) as folder:
        made = os.path.join(folder, "volume.zarr")
        write_volume(made, array, source="an array of Python", **more)
        command = json.dumps({"import": {"path": made, "name": name, "origin": {"kind": "array"}}})
        return Project(_native.Project.create(path, None, [command], None, True, more.get("progress")))


def _file_name(name: str) -> str:
    return "".join(c if c.isalnum() or c in "-_ " else "_" for c in name) or "_"
