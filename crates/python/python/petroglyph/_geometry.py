"""The lattice of a survey: line numbers, samples and places."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from petroglyph._errors import PetroglyphError

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]

#: Names that the vertical axis of an array may have, and the unit that each stands for where none is stated.
VERTICAL_NAMES = {"sample": None, "time": "ms", "twt": "ms", "depth": "m", "z": None}

#: Largest distance of a trace from the regular lattice, in bins.
_MAX_SHIFT_BINS = 0.25


@dataclass(frozen=True)
class Geometry:
    """The lattice of a survey. Only its steps are kept, so it is always regular.

    Attributes
    ----------
    inlines, crosslines : tuple of int
        First number, step and count.
    vertical : tuple of float, float and int
        First value, interval and count, positive down.
    unit : str
        ``"ms"`` (two-way time) or ``"m"``.
    origin, inline_vector, crossline_vector : tuple of float
        X and Y of the first trace, and of a step to the next inline and to the next crossline, in metres.
    velocity_m_s : float
        Velocity that turns two-way time into metres.
    """

    inlines: tuple[int, int, int]
    crosslines: tuple[int, int, int]
    vertical: tuple[float, float, int]
    unit: str = "ms"
    origin: tuple[float, float] = (0.0, 0.0)
    inline_vector: tuple[float, float] = (25.0, 0.0)
    crossline_vector: tuple[float, float] = (0.0, 25.0)
    velocity_m_s: float = 2000.0

    @staticmethod
    def regular(size: tuple[int, int, int], bin_m: float = 25.0, interval: float = 4.0, unit: str = "ms") -> Geometry:
        """A lattice of `size` that begins at inline 1, crossline 1 and 0, with square bins.

        Examples
        --------
        >>> Geometry.regular((3, 4, 5)).shape
        (3, 4, 5)
        """
        return Geometry(
            (1, 1, size[0]), (1, 1, size[1]), (0.0, interval, size[2]), unit, (0.0, 0.0), (bin_m, 0.0), (0.0, bin_m)
        )

    @property
    def shape(self) -> tuple[int, int, int]:
        """Counts of inlines, crosslines and samples."""
        return (self.inlines[2], self.crosslines[2], self.vertical[2])

    def is_close(self, other: Geometry) -> bool:
        """Whether every trace and sample lies where those of another lattice do, but for rounding, whatever the velocity."""
        numbers = [
            (*one.vertical, *one.origin, *one.inline_vector, *one.crossline_vector) for one in (self, other)
        ]
        near = all(abs(a - b) <= 1e-4 for a, b in zip(*numbers, strict=True))
        return near and (self.inlines, self.crosslines, self.unit) == (other.inlines, other.crosslines, other.unit)

    def to_json(self) -> str:
        """The lattice as stored volumes and projects write it."""
        first, interval, count = self.vertical
        return json.dumps(
            {
                "inlines": _axis(self.inlines),
                "crosslines": _axis(self.crosslines),
                "vertical": {"first": first, "interval": interval, "count": count, "unit": self.unit},
                "origin": list(self.origin),
                "inline_vector": list(self.inline_vector),
                "crossline_vector": list(self.crossline_vector),
                "velocity_m_s": self.velocity_m_s,
            }
        )

    @staticmethod
    def from_dict(found: dict[str, Any]) -> Geometry:
        """The lattice from the object that stored volumes and projects write."""
        def line(name: str) -> tuple[int, int, int]:
            return (found[name]["first"], found[name]["step"], found[name]["count"])

        def pair(name: str) -> tuple[float, float]:
            return (float(found[name][0]), float(found[name][1]))

        vertical = found["vertical"]
        return Geometry(
            line("inlines"),
            line("crosslines"),
            (vertical["first"], vertical["interval"], vertical["count"]),
            vertical["unit"],
            pair("origin"),
            pair("inline_vector"),
            pair("crossline_vector"),
            found["velocity_m_s"],
        )

    def coordinates(self) -> dict[str, tuple[tuple[str, ...], Any, dict[str, str]]]:
        """Coordinates for :class:`xarray.Dataset`: axes, values and attributes by name."""
        import numpy as np

        def numbers(axis: tuple[int, int, int]) -> Any:
            return axis[0] + axis[1] * np.arange(axis[2], dtype=np.int32)

        x, y = np.meshgrid(np.arange(self.inlines[2]), np.arange(self.crosslines[2]), indexing="ij")

        def place(n: int) -> Any:
            along, across = self.inline_vector[n], self.crossline_vector[n]
            return self.origin[n] + along * x.astype(float) + across * y.astype(float)

        first, interval, count = self.vertical
        name = "two-way time" if self.unit == "ms" else "depth"
        return {
            "inline": (("inline",), numbers(self.inlines), {"long_name": "inline number"}),
            "crossline": (("crossline",), numbers(self.crosslines), {"long_name": "crossline number"}),
            "sample": (("sample",), first + interval * np.arange(count), {"long_name": name, "units": self.unit}),
            "cdp_x": (("inline", "crossline"), place(0), {"long_name": "X of the trace", "units": "m"}),
            "cdp_y": (("inline", "crossline"), place(1), {"long_name": "Y of the trace", "units": "m"}),
        }

    @staticmethod
    def from_coordinates(
        inline: Any,
        crossline: Any,
        sample: Any,
        cdp_x: Any = None,
        cdp_y: Any = None,
        unit: str = "ms",
        velocity_m_s: float = 2000.0,
    ) -> Geometry:
        """The lattice on which coordinates lie.

        Parameters
        ----------
        inline, crossline, sample : array_like
            Line numbers and vertical values along each axis, in equal steps.
        cdp_x, cdp_y : array_like, optional
            Places of the traces, ``[inline][crossline]``, NaN where there is none; without them bins are 25 m wide.
        unit : str
            Unit of `sample`.
        velocity_m_s : float
            Velocity that turns two-way time into metres.

        Raises
        ------
        PetroglyphError
            The steps are not equal, or the traces do not lie on a regular lattice.
        """
        import numpy as np

        first, step, count = _steps("the inline numbers", inline)
        inlines = (round(first), round(step), count)
        first, step, count = _steps("the crossline numbers", crossline)
        crosslines = (round(first), round(step), count)
        vertical = _steps("the vertical values", sample)
        origin, along, across = (0.0, 0.0), (25.0, 0.0), (0.0, 25.0)
        if cdp_x is not None and cdp_y is not None:
            places = np.stack([np.asarray(cdp_x, dtype=float), np.asarray(cdp_y, dtype=float)], axis=-1)
            origin, along, across = _lattice(places)
        return Geometry(inlines, crosslines, vertical, unit, origin, along, across, velocity_m_s)


def _axis(axis: tuple[int, int, int]) -> dict[str, int]:
    return {"first": axis[0], "step": axis[1], "count": axis[2]}


def _steps(what: str, values: Any) -> tuple[float, float, int]:
    """First value, step and count of values in equal steps."""
    import numpy as np

    values = np.asarray(values, dtype=float)
    if values.ndim != 1 or values.size == 0 or not np.isfinite(values).all():
        raise PetroglyphError(f"{what} are not one row of numbers", "give one number for each line or sample")
    if values.size == 1:
        return float(values[0]), 1.0, 1
    step = float((values[-1] - values[0]) / (values.size - 1))
    if step == 0.0 or np.abs(np.diff(values) - step).max() > 1e-3 * abs(step):
        raise PetroglyphError(
            f"{what} do not go in equal steps", "bring the array onto a regular lattice, for instance by xarray's reindex"
        )
    return float(values[0]), step, int(values.size)


def _lattice(places: Floats) -> tuple[tuple[float, float], tuple[float, float], tuple[float, float]]:
    """Origin and steps of the lattice closest to the traces' places, which must lie on it."""
    import numpy as np

    nx, ny, _ = places.shape
    x, y = np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij")
    known = np.isfinite(places).all(axis=-1)
    # Traces that were never recorded often have the place (0, 0).
    known &= (places != 0.0).any(axis=-1) | (known & (x == 0) & (y == 0))
    if known.sum() < 3:
        return (0.0, 0.0), (25.0, 0.0), (0.0, 25.0)
    design = np.stack([np.ones(known.sum()), x[known], y[known]], axis=-1)
    solution, _, rank, _ = np.linalg.lstsq(design, places[known], rcond=None)
    if rank < 3:
        raise PetroglyphError(
            "the places of the traces lie on one line, so the lattice is not known", "give at least two lines both ways"
        )
    off = np.hypot(*(design @ solution - places[known]).T).max()
    bin_m = min(np.hypot(*solution[1]), np.hypot(*solution[2]))
    if off > _MAX_SHIFT_BINS * bin_m:
        raise PetroglyphError(
            f"a trace lies {off:.1f} m beside the regular lattice of bins of {bin_m:.1f} m",
            "check cdp_x and cdp_y, or leave them out",
        )

    def pair(row: Any) -> tuple[float, float]:
        return (float(round(row[0], 6)), float(round(row[1], 6)))

    return pair(solution[0]), pair(solution[1]), pair(solution[2])
