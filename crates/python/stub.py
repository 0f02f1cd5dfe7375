"""Writes the types of `petroglyph.program`, which only the built package can tell: program.pyi beside program.py.

    python stub.py FOLDER_OF_PETROGLYPH
"""

import inspect
import sys
from pathlib import Path

HEAD = """from petroglyph._calls import Answer, Value, Values
from petroglyph._calls import commands as commands
from petroglyph._calls import run as run
from petroglyph._types import Progress
"""

if __name__ == "__main__":
    folder = Path(sys.argv[1])
    sys.path.insert(0, str(folder))
    from petroglyph import program

    functions = [getattr(program, name) for name in program.__all__ if name not in ("commands", "run")]
    written = [f"def {one.__name__}{inspect.signature(one)}:\n    {one.__doc__!r}\n" for one in functions]
    (folder / "petroglyph" / "program.pyi").write_text("\n".join([HEAD, *written]))
