"""Every change of a project has its method."""

import inspect
import json

import petroglyph
import pytest
from petroglyph import _native
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
