"""Writes python/petroglyph/program.py: every command of the command line as a function, from what the program says of them.

    python make_program.py
"""

import json
import keyword
from pathlib import Path

from petroglyph import _native

OUT = Path(__file__).parent / "python" / "petroglyph" / "program.py"

HEAD = '''"""Every command of the command line as a function, with the same words and the same answers.

This file is made by ``make_program.py`` from what the program says of its commands. Options have ``_`` for ``-``; the
answer is the object of ``--json``. An error is a :class:`petroglyph.PetroglyphError` with the sentence and the hint of the
command line. Every function also takes `progress`, called as ``progress(stage, done, total)``.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from typing import Any

from petroglyph import _native

Path = str | os.PathLike[str]
Value = str | int | float | os.PathLike[str]
Values = Value | Sequence[Value]
Progress = Callable[[str, int, int], object]
Answer = dict[str, Any]


def run(
    *words: Value,
    progress: Progress | None = None,
    threads: int | None = None,
    **options: Values | bool | None,
) -> Answer:
    """Carries out any command.

    Parameters
    ----------
    *words
        The words that would be typed: the command, and what stands without an option.
    progress : callable, optional
        Called as ``progress(stage, done, total)``; what it raises cancels the command, as Ctrl-C does.
    threads : int, optional
        Threads to use; by default as many as there are processors.
    **options
        Options by their names, with ``_`` for ``-`` (and after a name that is a word of Python); ``True`` for those without
        a value, a list for those with several.
    """
    typed = [os.fspath(word) if isinstance(word, os.PathLike) else str(word) for word in words]
    for name, value in options.items():
        option = "--" + name.rstrip("_").replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            typed.append(option)
        elif isinstance(value, (str, int, float, os.PathLike)):
            typed.append(f"{option}={os.fspath(value) if isinstance(value, os.PathLike) else value}")
        else:
            typed.append(option)
            typed += [os.fspath(one) if isinstance(one, os.PathLike) else str(one) for one in value]
    answer: Answer = json.loads(_native.run(typed, progress, threads))
    return answer


def commands() -> list[dict[str, Any]]:
    """Every command: its ``words``, what it is ``about``, and its ``options``."""
    found: list[dict[str, Any]] = json.loads(_native.commands())
    return found
'''


def name_of(word):
    name = word.replace("-", "_")
    return f"{name}_" if keyword.iskeyword(name) or name in ("import", "open") else name


def folded(text, indent):
    """A docstring's text in lines of at most 120 columns."""
    lines, line = [], ""
    for word in text.split():
        if len(indent) + len(line) + len(word) + 1 > 118:
            lines.append(indent + line)
            line = word
        else:
            line = f"{line} {word}".strip()
    return "\n".join([*lines, indent + line])


def function(command):
    name = name_of("_".join(command["words"]))
    places = [option for option in command["options"] if option["positional"]]
    named = [option for option in command["options"] if not option["positional"] and option["name"] not in ("json", "version")]
    head, call, doc = [], [f'"{word}"' for word in command["words"]], []
    after = False
    for option in places:
        own = name_of(option["name"])
        if option["several"]:
            head.append(f"*{own}: Value")
            call.append(f"*{own}")
            after = True
        elif option["required"] and not after:
            head.append(f"{own}: Value")
            call.append(own)
        else:
            head.append(f"{own}: Value | None = None")
            call.append(f"*([] if {own} is None else [{own}])")
        doc.append((own, "value" if option["required"] else "value, optional", option["help"]))
    if not after:
        head.append("*")
    for option in named:
        own = name_of(option["name"])
        kind = "bool = False" if not option["takes_value"] else ("Values | None = None" if option["several"] else "Value | None = None")
        head.append(f"{own}: {kind}")
        call.append(f"{own}={own}")
        told = "bool" if not option["takes_value"] else ("value or values, optional" if option["several"] else "value, optional")
        doc.append((own, told, option["help"]))
    head.append("progress: Progress | None = None")
    call.append("progress=progress")
    lines = ["", "", f"def {name}("] + [f"    {part}," for part in head] + [") -> Answer:"]
    about = folded((command["about"] or "Carries out the command") + ".", "    ").lstrip()
    lines.append(f'    """{about}')
    lines += ["", "    Parameters", "    ----------"]
    for own, told, text in doc:
        text = (text.replace("\\", "\\\\") or "As of the command line").rstrip(".") + "."
        lines += [f"    {own} : {told}", folded(text[0].upper() + text[1:], "        ")]
    lines += ["    progress : callable, optional", "        Called as ``progress(stage, done, total)``.", '    """']
    lines.append("    return run(")
    lines += [f"        {part}," for part in call]
    lines.append("    )")
    return "\n".join(lines)


def text():
    return HEAD + "\n".join(function(command) for command in json.loads(_native.commands())) + "\n"


if __name__ == "__main__":
    OUT.write_text(text())
