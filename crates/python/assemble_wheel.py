"""Puts an extension that is built already and the Python sources into a wheel, so that tests compile nothing again.

    python assemble_wheel.py EXTENSION OUT_FOLDER

`make wheel` builds a wheel to give away, by maturin.
"""

import base64
import hashlib
import re
import sys
import sysconfig
import zipfile
from pathlib import Path

HERE = Path(__file__).parent


def main(extension: Path, out: Path) -> None:
    version = re.search(r'^version = "(.*)"', (HERE / "../../Cargo.toml").read_text(), re.MULTILINE)[1]
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    files = {}
    for path in sorted((HERE / "python").rglob("*")):
        if path.is_file() and path.suffix in (".py", ".pyi", ".typed"):
            files[path.relative_to(HERE / "python").as_posix()] = path.read_bytes()
    files["petroglyph/py.typed"] = b""
    files["petroglyph/_native.abi3.so"] = extension.read_bytes()
    info = f"petroglyph-{version}.dist-info"
    files[f"{info}/METADATA"] = f"Metadata-Version: 2.1\nName: petroglyph\nVersion: {version}\n".encode()
    files[f"{info}/WHEEL"] = (
        f"Wheel-Version: 1.0\nGenerator: assemble_wheel\nRoot-Is-Purelib: false\nTag: cp311-abi3-{platform}\n".encode()
    )
    record = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record.append(f"{name},sha256={digest},{len(content)}")
    files[f"{info}/RECORD"] = "\n".join([*record, f"{info}/RECORD,,", ""]).encode()
    out.mkdir(parents=True, exist_ok=True)
    wheel = out / f"petroglyph-{version}-cp311-abi3-{platform}.whl"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_STORED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    print(wheel)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
