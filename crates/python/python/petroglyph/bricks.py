"""Stages as pure functions on a brick: its samples with a halo in, the result out, on one thread, without any cache.

A brick is ``[inline][crossline][sample]`` in ``float32``, with all the samples of its traces. What comes out has the shape
of what went in; its inner part, without the halo that :func:`halo` names, is the same whatever the tiling, bit by bit.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Literal

from petroglyph import _native
from petroglyph._types import Options

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from petroglyph._geometry import Geometry

    Samples = npt.NDArray[np.float32]
    Mask = npt.NDArray[np.bool_]

#: Bytes that a stage holds for each sample of the brick with its halo: the brick, what is computed on the way, the result.
#: The envelope of a trace is computed in little beside.
BYTES_HELD = {
    "envelope": 12,
    "dip": 24,
    "dip-angle": 20,
    "semblance": 28,
    "fault-likelihood": 32,
    "throw": 36,
    "extrema": 10,
}


def _json(options: Options | None) -> str | None:
    return None if options is None else json.dumps(dict(options))


def halo(
    kind: str, *, dip: Options | None = None, semblance: Options | None = None, geometry: Geometry | None = None
) -> int:
    """Lines that a brick needs around it, to all four sides.

    Parameters
    ----------
    kind : {"envelope", "dip", "semblance", "fault-likelihood", "throw", "dip-angle", "extrema"}
        The stage.
    dip, semblance : mapping, optional
        Settings, as of :meth:`petroglyph.Project.attribute`.
    geometry : Geometry, optional
        That of the survey, which a fault likelihood and throws need.
    """
    return _native.reach(kind, _json(dip), _json(semblance), geometry.to_json() if geometry else None)


def envelope(samples: Samples, live: Mask | None = None) -> Samples:
    """The strength of the reflections, whatever their phase."""
    return _native.envelope(samples, live)


def dip(samples: Samples, live: Mask | None = None, *, settings: Options | None = None) -> tuple[Samples, Samples]:
    """How many samples deeper the reflections are on the next inline, and on the next crossline."""
    inline, crossline = _native.dip(samples, live, _json(settings))
    return inline, crossline


def semblance(
    samples: Samples, live: Mask | None = None, *, dip: Options | None = None, settings: Options | None = None
) -> Samples:
    """How alike neighbouring traces are along the reflections: low at faults."""
    return _native.semblance(samples, live, _json(dip), _json(settings))


def fault_likelihood(samples: Samples, geometry: Geometry, live: Mask | None = None) -> Samples:
    """Where a steep plane breaks the reflections, 0 to 1; ``geometry`` is that of the survey."""
    return _native.fault_likelihood(samples, geometry.to_json(), live)


def throw(samples: Samples, geometry: Geometry, live: Mask | None = None) -> Samples:
    """The throw, samples, where the fault likelihood has a ridge and both its sides match after a shift; else NaN.

    It is positive of normal faults and negative of reverse ones; ``geometry`` is that of the survey.
    """
    return _native.throw(samples, geometry.to_json(), live)


def dip_angle(inline: Samples, crossline: Samples, geometry: Geometry, live: Mask | None = None) -> Samples:
    """The angle of the reflections from the horizontal, degrees, from the two dips of :func:`dip`."""
    return _native.dip_angle(inline, crossline, geometry.to_json(), live)


def extrema(
    samples: Samples, kind: Literal["peak", "trough", "zero"], live: Mask | None = None
) -> tuple[npt.NDArray[np.uint32], Samples, Samples]:
    """Extrema of every trace, refined between samples.

    Returns
    -------
    counts : ndarray of uint32
        Extrema of each trace, in the order of the traces.
    z, amplitude : ndarray of float32
        Fractional sample and height of each extremum, trace after trace from the top down.
    """
    return _native.extrema(samples, kind, live)
