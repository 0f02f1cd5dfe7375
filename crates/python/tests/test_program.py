"""Every command of the command line is a function, and each of its options takes what the command line takes."""

import inspect
import os
import pydoc
import subprocess

import petroglyph
import pytest
from petroglyph import _calls, program

COMMANDS = program.commands()
#: Values of every option that takes several, and of every option that must be given.
VALUES = {
    "annotate": ["axes", "layers"],
    "at": (100, 200, 300.0),
    "between": ["Alpha", "Bravo"],
    "correlation": ["A-1", "A-2"],
    "count": 3,
    "crossline": range(100, 102),
    "cut": ["nearest", ("min-min", 0.3, 0.3)],
    "cut-box": [(100, 105, 200, 205, -8, 0), (110, 115, 200, 205, 0, 40)],
    "cut-fence": [(100, 200), "well:A-1", (120, 210)],
    "cut-plane": [(100, 200, 40, 30, 45), (110, 200, 40, 30, 45)],
    "cut-round": [(100, 200, 50), (110, 200, 50)],
    "extent": ["grow", 150],
    "fence": [(100, 200), (110, 200), (120, 210)],
    "font": ["a.ttf", "b.ttf"],
    "horizon": [("Alpha", "#ff0000"), "Bravo"],
    "inline": [101, 120],
    "interval": [(0, 0.5, "sandstone"), (0.5, 1, "shale")],
    "isosurface": [("k", 0.5), ("seismic", 1.5)],
    "las": ["a.las", "b.las"],
    "line": [(100, 200, 40), (110, 200, 44)],
    "log": ["GR", "none"],
    "name": "Alpha",
    "scene": ["corner", "front"],
    "slice": [-4.0, 100.5],
    "stages": [1, 2.5],
    "stick": [[(100, 200, 10), (100, 201, 60)], [(110, 200, 10), (110, 201, 60)]],
    "values": ["seismic", "envelope"],
}
#: What some options need beside them.
BESIDE = {"log": {"correlation": True}, "values": {"horizon": "Alpha"}}
#: Files that commands write.
OUT = {"animate": "out.gif", "export": "out.csv", "review": "out.html"}


def has_several(option):
    return option["repeats"] or option["values"][1] not in (0, 1)


def function_of(command):
    name = "_".join(command["words"]).replace("-", "_")
    return getattr(program, name, None) or getattr(program, f"{name}_")


def own(option):
    return option["name"].replace("-", "_")


def refusal(function, *words, **options):
    with pytest.raises(petroglyph.PetroglyphError) as caught:
        function(*words, **options)
    return caught.value.reason


LISTS = [(command, option) for command in COMMANDS for option in command["options"] if has_several(option)]


def test_there_are_such_options():
    assert len(LISTS) > 35 and len({option["name"] for _, option in LISTS}) > 20


@pytest.mark.parametrize(("command", "option"), LISTS, ids=lambda told: " ".join(told.get("words", [told.get("name", "")])))
def test_every_option_that_takes_several_values_takes_a_list(command, option, tmp_path):
    """The command line has understood all of it where it finds no project, and nothing else is wrong."""
    missing = tmp_path / "missing.petro"
    places = {"project": missing, "out": tmp_path / OUT.get(command["words"][0], "out.png")}
    words, named = [], {own(option): VALUES[option["name"]], **BESIDE.get(option["name"], {})}
    for needed in filter(lambda one: one["required"], command["options"]):
        value = places.get(needed["name"], VALUES.get(needed["name"], "Alpha"))
        if needed["positional"]:
            named.pop(own(needed), None)
            words += value if has_several(needed) else [value]
        else:
            named[own(needed)] = value
    assert refusal(function_of(command), *words, **named) == refusal(program.info, missing)


def test_values_arrive_as_they_were_given(project, tmp_path):
    program.scene_add(project.path, "corner", cut=["min-min,0.2,0.2", ("max-max", 0.3, 0.3)], cut_box=[])
    project.reload()
    assert len(project.document["scenes"][0]["scene"]["cut_outs"]) == 2
    x, y = project.geometry.inlines[0] + 3, project.geometry.crosslines[0] + 4
    for lines in (x, [x], [x, x + 9], range(x, x + 3)):
        done = program.render(project.path, tmp_path / "sections.png", inline=lines, size_cm="6x4", dpi=60)
        assert done["parts"] == (1 if lines == x else len(lines))
    sticks = [[(x, y, 20), (x, y, 120)], [(x + 9, y, 20), (x + 9, y, 60), (x + 9, y, 120)]]
    assert "2 sticks" in program.fault_pick(project.path, name="Drawn", stick=sticks)["summary"]


def test_what_is_typed_follows_from_what_the_option_takes():
    def typed(values, repeats, value):
        return _calls._typed("x", {"values": values, "repeats": repeats}, value)

    assert typed((0, 0), False, True) == ["--x"] and typed((0, 0), False, False) == typed((1, 1), False, None) == []
    assert typed((1, 1), False, (-1, 2.5, "a")) == typed((1, 1), False, [-1, 2.5, "a"]) == ["--x=-1,2.5,a"]
    assert typed((1, 1), True, "a") == ["--x=a"] and typed((1, 1), True, []) == []
    assert typed((1, 1), True, [-1, (2, 3)]) == ["--x=-1", "--x=2,3"]
    assert typed((2, None), True, [(1, 2), (3, 4)]) == ["--x", "1,2", "3,4"]
    assert typed((1, None), True, [[(1, 2), (3, 4)], [(5, 6)]]) == ["--x", "1,2", "3,4", "--x", "5,6"]
    assert typed((0, None), True, []) == typed((0, None), True, True) == ["--x"]


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: " ".join(command["words"]))
def test_every_command_is_a_function_with_its_options(command):
    function = function_of(command)
    signature = inspect.signature(function)
    names = [name.rstrip("_").replace("_", "-") for name in signature.parameters]
    assert names == [option["name"] for option in sorted(command["options"], key=lambda option: not option["positional"])] + ["progress"]
    told = pydoc.plain(pydoc.render_doc(function))
    assert f"{function.__name__}(" in told and command["about"] in " ".join(told.split())
    assert all(f"{name} : " in told for name in signature.parameters)


def test_what_is_no_argument_is_refused_as_by_any_function():
    with pytest.raises(TypeError, match="frobnicate"):
        program.info("a.petro", frobnicate=True)
    with pytest.raises(TypeError, match="path"):
        program.info()


def test_functions_are_those_of_the_program_that_is_built():
    path = os.environ.get("PETROGLYPH_PROGRAM")
    if not path:
        pytest.skip("PETROGLYPH_PROGRAM names no program to compare with")
    told = subprocess.run([path, "--help"], capture_output=True, text=True, check=True).stdout
    first = {command["words"][0] for command in COMMANDS}
    listed = told.split("Commands:")[1].split("Options:")[0].splitlines()
    words = {line.split()[0] for line in listed if line.startswith("  ") and line[2:3].strip()}
    assert words - {"help"} == first


