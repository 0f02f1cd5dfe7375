"""The build backend of the Python package: maturin's, which also brings the types of `petroglyph.program` (stub.py).

    python backend.py WHEEL...     adds them to wheels that maturin itself has made
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import maturin
from maturin import *  # noqa: F403

HERE = Path(__file__).parent


def _python(*words):
    subprocess.run([sys.executable, *words], check=True, stdout=sys.stderr)


def add_types(wheel):
    with tempfile.TemporaryDirectory() as folder:
        _python("-m", "wheel", "unpack", "--dest", folder, wheel)
        (package,) = Path(folder).iterdir()
        _python(HERE / "stub.py", package)
        _python("-m", "wheel", "pack", "--dest-dir", wheel.parent, package)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    name = maturin.build_wheel(wheel_directory, config_settings, metadata_directory)
    add_types(Path(wheel_directory, name))
    return name


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    name = maturin.build_editable(wheel_directory, config_settings, metadata_directory)
    _python(HERE / "stub.py", HERE / "python")
    return name


if __name__ == "__main__":
    for wheel in sys.argv[1:]:
        add_types(Path(wheel))
