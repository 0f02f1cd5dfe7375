"""The package brings the types of the functions that are made when it is imported, however it was built."""

import runpy
import shutil
import subprocess
import sys
import types
import zipfile
from pathlib import Path

import petroglyph

HERE = Path(__file__).parent.parent
INSTALLED = Path(petroglyph.__file__).parent


def test_the_types_of_every_function_are_known(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "from petroglyph import program\n"
        'done = program.render("a.petro", "a.png", inline=[101, 120], cut_fence=[(1, 2), (3, 4)], legend=True)\n'
        "reveal_type(done)\n"
        'program.render("a.petro", "a.png", inlines=[101])\n'
        'program.render("a.petro")\n'
    )
    words = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache", script]
    told = subprocess.run(words, capture_output=True, text=True).stdout
    assert 'note: Revealed type is "dict[str, Any]"' in told
    assert '"inlines" for "render"' in told and 'Missing positional argument "out"' in told and "Found 2 errors" in told


def test_the_backend_adds_them_to_the_wheel(tmp_path, monkeypatch):
    package = tmp_path / "petroglyph-1"
    shutil.copytree(INSTALLED, package / "petroglyph", ignore=shutil.ignore_patterns("program.pyi", "__pycache__"))
    about = package / "petroglyph-1.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: petroglyph\nVersion: 1\n")
    (about / "WHEEL").write_text("Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: false\nTag: cp311-abi3-any\n")

    def build_wheel(folder, *_):
        subprocess.run([sys.executable, "-m", "wheel", "pack", "--dest-dir", folder, package], check=True)
        return "petroglyph-1-cp311-abi3-any.whl"

    maturin = types.SimpleNamespace(build_wheel=build_wheel)
    monkeypatch.setitem(sys.modules, "maturin", maturin)
    out = tmp_path / "out"
    out.mkdir()
    wheel = out / runpy.run_path(str(HERE / "backend.py"))["build_wheel"](str(out))
    assert list(out.iterdir()) == [wheel]
    with zipfile.ZipFile(wheel) as found:
        assert found.read("petroglyph/program.pyi") == (INSTALLED / "program.pyi").read_bytes()
        assert "petroglyph/program.pyi,sha256=" in found.read("petroglyph-1.dist-info/RECORD").decode()
