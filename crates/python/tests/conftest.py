"""A small synthetic survey and a project of it, made once."""

import shutil

import numpy as np
import petroglyph
import pytest


@pytest.fixture(scope="session")
def synth(tmp_path_factory):
    """A folder that `petroglyph synth` wrote."""
    out = tmp_path_factory.mktemp("synth")
    petroglyph.program.synth(out, size="40x36x48", seed=7, snr="5")
    return out


@pytest.fixture(scope="session")
def made(synth, tmp_path_factory):
    """A project with a volume, horizons and a fault; it is copied before it is changed."""
    project = petroglyph.import_segy(synth / "survey.sgy", tmp_path_factory.mktemp("made") / "north.petro")
    for name in ("Alpha", "Bravo", "Charlie"):
        project.add_horizon(synth / "horizons" / f"{name}.csv", name)
    project.add_fault(synth / "faults" / "Normal fault.ts", "F1")
    return project


@pytest.fixture
def project(made, tmp_path):
    """A project of its own for each test."""
    path = tmp_path / "north.petro"
    shutil.copytree(made.path, path)
    return petroglyph.open(path)


@pytest.fixture(scope="session")
def larger(tmp_path_factory):
    """A project with a volume of several files and levels, and with dead traces."""
    geometry = petroglyph.Geometry.regular((150, 140, 70))
    random = np.random.default_rng(5)
    x, y, z = np.meshgrid(*(np.arange(n, dtype=np.float32) for n in geometry.shape), indexing="ij")
    samples = np.sin(0.5 * (z + 0.2 * x - 0.1 * y)) + 0.1 * random.standard_normal(geometry.shape)
    live = random.random(geometry.shape[:2]) > 0.02
    samples = np.where(live[..., None], samples, 0.0).astype(np.float32)
    path = tmp_path_factory.mktemp("larger") / "large.petro"
    return petroglyph.import_volume(samples, path, geometry=geometry, live=live)


@pytest.fixture
def large(larger, tmp_path):
    """The larger project, of its own for each test."""
    path = tmp_path / "large.petro"
    shutil.copytree(larger.path, path)
    return petroglyph.open(path)
