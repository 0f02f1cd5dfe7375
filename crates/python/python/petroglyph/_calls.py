"""Commands of the command line as calls: any of them by its words, and a function for each."""

from __future__ import annotations

import functools
import inspect
import json
import keyword
import os
import textwrap
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from petroglyph import _native
from petroglyph._types import Progress

#: One value of an option: text, a number, a file, or a tuple of the parts that the command line joins by commas.
Value = str | float | os.PathLike[str] | tuple[str | float, ...]
#: One value or several; several lists of values for what is said several times with several values each time.
Values = Value | Sequence[Value] | Sequence[Sequence[Value]]
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
        a value, a list for those with several. Values with commas may be tuples: ``at=(1250, 830, 1432.0)``.
    """
    known = _options_of(words)
    typed = [_text(word) for word in words]
    for own, value in options.items():
        name = own.rstrip("_").replace("_", "-")
        typed += _typed(name, known.get(name, {"values": (1, 1), "repeats": False}), value)
    answer: Answer = json.loads(_native.run(typed, progress, threads))
    return answer


def commands() -> list[dict[str, Any]]:
    """Every command: its ``words``, what it is ``about``, and its ``options``.

    Each option has its ``name`` and ``help``, how many ``values`` it takes each time it is given (the least, and the most or
    ``None``), their ``value_names``, and whether it is ``positional``, is ``required`` and ``repeats``.
    """
    found: list[dict[str, Any]] = json.loads(_native.commands())
    return found


@functools.cache
def _known() -> dict[tuple[str, ...], dict[str, dict[str, Any]]]:
    """Options by their names, of commands by their words."""
    return {tuple(told["words"]): {option["name"]: option for option in told["options"]} for told in commands()}


def _options_of(words: tuple[Value, ...]) -> dict[str, dict[str, Any]]:
    """Options of the command that these words begin with; none where it is no command."""
    return next((options for command, options in _known().items() if words[: len(command)] == command), {})


def _is_list(value: Any) -> bool:
    return isinstance(value, Iterable) and not isinstance(value, (str, os.PathLike))


def _text(value: Any) -> str:
    """One value as it would be typed."""
    return ",".join(map(str, value)) if _is_list(value) else os.fspath(value) if isinstance(value, os.PathLike) else str(value)


def _has_several(option: dict[str, Any]) -> bool:
    return bool(option["repeats"] or option["values"][1] not in (0, 1))


def _typed(name: str, option: dict[str, Any], value: Any) -> list[str]:
    """What would be typed for an option that has this value."""
    if value is None or value is False:
        return []
    if value is True:
        return [f"--{name}"]
    if not _is_list(value) or not _has_several(option):
        return [f"--{name}={_text(value)}"]
    if option["values"][1] == 1:
        return [f"--{name}={_text(one)}" for one in value]
    given = list(value)
    times = given if any(isinstance(one, list) for one in given) else [given]
    return [word for one in times for word in (f"--{name}", *map(_text, one))]


def functions() -> dict[str, Callable[..., Answer]]:
    """A function for each command, by its name."""
    return {made.__name__: made for made in map(_function, commands())}


def _name(word: str) -> str:
    name = word.replace("-", "_")
    return f"{name}_" if keyword.iskeyword(name) or name == "open" else name


def _function(command: dict[str, Any]) -> Callable[..., Answer]:
    places = {_name(option["name"]): option for option in command["options"] if option["positional"]}
    named = {_name(option["name"]): option for option in command["options"] if not option["positional"]}
    parameters, described = [], [f"{command['about']}.", "", "Parameters", "----------"]
    for name, option in (places | named).items():
        parameter, kind = _parameter(name, option)
        parameters.append(parameter)
        about = (option["help"] or "As of the command line").rstrip(".")
        described += [f"{name} : {kind}", _folded(f"{about[0].upper()}{about[1:]}.")]
    parameters.append(inspect.Parameter("progress", inspect.Parameter.KEYWORD_ONLY, default=None, annotation="Progress | None"))
    described += ["progress : callable, optional", _folded("Called as ``progress(stage, done, total)``.")]
    signature = inspect.Signature(parameters, return_annotation="Answer")

    def function(*given: Any, **options: Any) -> Answer:
        told = signature.bind(*given, **options).arguments
        words = list(command["words"])
        for name, option in places.items():
            value = told.pop(name, None)
            words += [] if value is None else value if _has_several(option) else [value]
        return run(*words, **told)

    function.__name__ = function.__qualname__ = _name("_".join(command["words"]))
    function.__module__ = "petroglyph.program"
    function.__doc__ = "\n".join([*described, ""])
    function.__signature__ = signature  # type: ignore[attr-defined]
    return function


def _parameter(name: str, option: dict[str, Any]) -> tuple[inspect.Parameter, str]:
    """The parameter of an option, and what its values are in words."""
    is_positional, has_several = option["positional"], _has_several(option)
    if is_positional and has_several:
        return inspect.Parameter(name, inspect.Parameter.VAR_POSITIONAL, annotation="Value"), "values"
    if is_positional and option["required"]:
        return inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD, annotation="Value"), "value"
    kind = inspect.Parameter.POSITIONAL_OR_KEYWORD if is_positional else inspect.Parameter.KEYWORD_ONLY
    least, most = option["values"]
    if most == 0:
        return inspect.Parameter(name, kind, default=False, annotation="bool"), "bool"
    annotation, told = ("Values", "value or list of values") if has_several else ("Value", "value")
    if least == 0:
        annotation, told = f"{annotation} | bool", f"{told}, or True"
    return inspect.Parameter(name, kind, default=None, annotation=f"{annotation} | None"), f"{told}, optional"


def _folded(text: str) -> str:
    return textwrap.fill(" ".join(text.split()), 100, initial_indent="    ", subsequent_indent="    ")
