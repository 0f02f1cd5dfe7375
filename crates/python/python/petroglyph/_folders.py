"""Folders that are written beside their place and get it when they are complete.

A call removes only the folder that it has made itself, whatever other processes write at the same time.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator

from petroglyph._errors import PetroglyphError
from petroglyph._types import Path


@contextlib.contextmanager
def beside(path: Path) -> Iterator[str]:
    """A new folder of this call alone on the disk of `path`, which is removed in the end with what is still in it."""
    parent, name = os.path.split(os.path.abspath(path))
    os.makedirs(parent, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f".{name}.", dir=parent, ignore_cleanup_errors=True) as folder:
        yield folder


@contextlib.contextmanager
def written(path: Path) -> Iterator[str]:
    """Where to write what is then at `path`, complete or not at all; what is there already stays."""
    if os.path.lexists(path):
        raise _exists(path)
    with beside(path) as folder:
        partial = os.path.join(folder, "written")
        yield partial
        try:
            os.rename(partial, path)
        except OSError as error:
            raise (_exists(path) if os.path.lexists(path) else error) from None


def _exists(path: Path) -> PetroglyphError:
    return PetroglyphError(f"{os.fspath(path)} exists already", "remove it first, or write elsewhere")
