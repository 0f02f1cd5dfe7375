"""Every command has its twin."""

import inspect
import json
import os
import runpy
import subprocess
from pathlib import Path

import petroglyph
import pytest
from petroglyph import _native, program
from petroglyph._commands import Commands

FIELDS = json.loads(_native.command_fields())
#: Names of methods that differ from those of their commands, because Python's own words are taken.
METHODS = {"import": "import_"}
#: What a method says in other words than the command's fields.
WORDS = {"from": "from_", "picks": "places", "level": "through", "note": "text", "memory_bytes": "memory"}


def method_of(command):
    return METHODS.get(command, command.replace("-", "_"))


def test_commands_are_known():
    assert len(FIELDS) > 35
    assert FIELDS["set-velocity"] == ["velocity_m_s"]
    assert "create" in FIELDS


@pytest.mark.parametrize("command", sorted(set(FIELDS) - {"create"}))
def test_every_command_has_a_method_with_its_fields(command):
    method = getattr(Commands, method_of(command))
    parameters = set(inspect.signature(method).parameters)
    for field in FIELDS[command]:
        assert WORDS.get(field, field) in parameters, f"{command} has no {field}"
    assert method.__doc__, command


def test_creating_has_a_function_in_place_of_a_method():
    assert FIELDS["create"] == ["geometry"]
    assert "geometry" in inspect.signature(petroglyph.create).parameters


def test_every_command_of_the_command_line_has_a_function():
    for command in program.commands():
        name = "_".join(command["words"]).replace("-", "_")
        function = getattr(program, name, None) or getattr(program, f"{name}_")
        known = set(inspect.signature(function).parameters)
        for option in command["options"]:
            own = option["name"].replace("-", "_")
            assert option["name"] in ("json", "wait", "version") or own in known or f"{own}_" in known, (name, own)


def test_functions_are_what_make_program_writes():
    maker = runpy.run_path(str(Path(__file__).parent.parent / "make_program.py"))
    assert maker["OUT"].read_text() == maker["text"](), "run make_program.py again"


def test_functions_are_those_of_the_program_that_is_built():
    path = os.environ.get("PETROGLYPH_PROGRAM")
    if not path:
        pytest.skip("PETROGLYPH_PROGRAM names no program to compare with")
    told = subprocess.run([path, "--help"], capture_output=True, text=True, check=True).stdout
    first = {command["words"][0] for command in program.commands()}
    listed = told.split("Commands:")[1].split("Options:")[0].splitlines()
    words = {line.split()[0] for line in listed if line.startswith("  ") and line[2:3].strip()}
    assert words - {"help"} == first


def test_apply_takes_any_command_and_tells_what_it_did(project):
    done = project.apply({"set-velocity": {"velocity_m_s": 2500.0}})
    assert done["text"] and project.geometry.velocity_m_s == 2500.0
    assert project.history[-1]["in_effect"]
    assert project.undo() and project.geometry.velocity_m_s == 2000.0
    assert project.redo() and project.geometry.velocity_m_s == 2500.0


def test_what_is_no_command_is_refused(project):
    with pytest.raises(ValueError, match="unknown variant"):
        project.apply({"set-gravity": {}})
    with pytest.raises(ValueError, match="velocity_m_s"):
        project.apply({"set-velocity": {}})
