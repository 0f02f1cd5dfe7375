"""Petroglyph: illustrations and horizons from 3D seismic surveys.

>>> import petroglyph
>>> project = petroglyph.import_segy("survey.sgy", "north.petro")     # doctest: +SKIP
>>> project.add_horizon("top.irap", name="Top Chalk")                 # doctest: +SKIP
>>> project.render(cut="nearest,0.45,0.45")                           # doctest: +SKIP

======================== ==========================================================================
:class:`Project`          a project: its data as arrays, pictures, and every command that changes it
:mod:`petroglyph.program` every command of the command line as a function
:mod:`petroglyph.bricks`  stages as pure functions on a brick with its halo
:mod:`petroglyph.dask`    the same stages as graphs over stored volumes, on any Dask scheduler
:mod:`petroglyph.mdio`    MDIO v1 volumes, read and written
======================== ==========================================================================
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from petroglyph._errors import PetroglyphError, PetroglyphWarning
from petroglyph._native import STORE_VERSION, __version__

if TYPE_CHECKING:
    from petroglyph import bricks, dask, mdio, program
    from petroglyph._geometry import Geometry
    from petroglyph._project import Fault, Horizon, Picture, Project, Volume, create, import_segy, import_volume, open
    from petroglyph._stored import open_volume, write_volume

__all__ = [
    "STORE_VERSION",
    "Fault",
    "Geometry",
    "Horizon",
    "PetroglyphError",
    "PetroglyphWarning",
    "Picture",
    "Project",
    "Volume",
    "__version__",
    "bricks",
    "create",
    "dask",
    "import_segy",
    "import_volume",
    "mdio",
    "open",
    "open_volume",
    "program",
    "write_volume",
]

_HOMES = {
    "Geometry": "_geometry",
    "open_volume": "_stored",
    "write_volume": "_stored",
    **dict.fromkeys(
        ["Fault", "Horizon", "Picture", "Project", "Volume", "create", "import_segy", "import_volume", "open"], "_project"
    ),
}


def __getattr__(name: str) -> Any:
    """Loads a part when it is first used, so that importing the package takes no time."""
    import importlib

    if name in ("bricks", "dask", "mdio", "program"):
        return importlib.import_module(f"petroglyph.{name}")
    if name in _HOMES:
        return getattr(importlib.import_module(f"petroglyph.{_HOMES[name]}"), name)
    raise AttributeError(f"module 'petroglyph' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
