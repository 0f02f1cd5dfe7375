"""Every command of the command line as a function, with the same words and the same answers.

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


def demo(
    *,
    out: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Run the whole chain from a synthetic survey to finished pictures.

    Parameters
    ----------
    out : value, optional
        Folder to write into.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "demo",
        out=out,
        progress=progress,
    )


def illustrate(
    survey: Value,
    out: Value,
    *,
    layers: Value | None = None,
    project: Value | None = None,
    device: Value | None = None,
    volume_memory: Value | None = None,
    inline_byte: Value | None = None,
    crossline_byte: Value | None = None,
    line_type: Value | None = None,
    line_numbers: Value | None = None,
    x_byte: Value | None = None,
    y_byte: Value | None = None,
    coordinate_type: Value | None = None,
    scalar_byte: Value | None = None,
    coordinate_scalar: Value | None = None,
    byte_order: Value | None = None,
    sample_format: Value | None = None,
    interval: Value | None = None,
    start: Value | None = None,
    vertical_unit: Value | None = None,
    coordinate_unit: Value | None = None,
    bin: Value | None = None,
    trace_weight: Value | None = None,
    duplicates: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Draw a block of a survey that nobody has interpreted, with layers of one geologic time.

    Parameters
    ----------
    survey : value
        SEG-Y file.
    out : value
        File to write: .png or .tif for pixels, .svg or .pdf for paths and text.
    layers : value, optional
        Number of layers, at least 2; fewer are drawn where fewer levels stand out.
    project : value, optional
        Project folder to create, to go on from [default: OUT with the ending .petro].
    device : value, optional
        Device that draws: the graphics adapter, or the processor when there is none (auto), or one of the two.
    volume_memory : value, optional
        Largest memory for the samples of one volume, such as 2G; a larger volume is shown at a coarser level of its
        pyramid [default: half of what is free].
    inline_byte : value, optional
        Trace header byte of the inline number.
    crossline_byte : value, optional
        Trace header byte of the crossline number.
    line_type : value, optional
        How line numbers are stored: i32, i16, u16, f32, f64 or ibm32 [default: i32, else what is found].
    line_numbers : value, optional
        Where line numbers come from: headers, coordinates (the lattice of X and Y, numbered from 1) or
        coordinates-swapped [default: headers].
    x_byte : value, optional
        Trace header byte of X.
    y_byte : value, optional
        Trace header byte of Y.
    coordinate_type : value, optional
        How X and Y are stored: i32, i16, u16, f32, f64 or ibm32 [default: i32, else f32 if that gives valid places].
    scalar_byte : value, optional
        Trace header byte of the coordinate scalar [default: 71].
    coordinate_scalar : value, optional
        Coordinate scalar, whatever the file holds: 10 multiplies by ten, -10 divides.
    byte_order : value, optional
        Byte order: big or little.
    sample_format : value, optional
        Sample format, whatever the header says: ibm32, ieee32, ieee64, int8, int16, int24, int32, int64, uint8, .
    interval : value, optional
        Sample interval, in the vertical unit.
    start : value, optional
        Value of the first sample, in the vertical unit.
    vertical_unit : value, optional
        Vertical unit: ms, m or ft.
    coordinate_unit : value, optional
        Unit of X and Y: m or ft.
    bin : value, optional
        Ignore X and Y: square bins of this size in metres, from 0, 0.
    trace_weight : value, optional
        Trace weight N at byte 169: apply (2^-N, the standard), inverse (2^N) or ignore [default: apply].
    duplicates : value, optional
        Which of several traces at one place to keep: first or last [default: first, if they are few].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "illustrate",
        survey,
        out,
        layers=layers,
        project=project,
        device=device,
        volume_memory=volume_memory,
        inline_byte=inline_byte,
        crossline_byte=crossline_byte,
        line_type=line_type,
        line_numbers=line_numbers,
        x_byte=x_byte,
        y_byte=y_byte,
        coordinate_type=coordinate_type,
        scalar_byte=scalar_byte,
        coordinate_scalar=coordinate_scalar,
        byte_order=byte_order,
        sample_format=sample_format,
        interval=interval,
        start=start,
        vertical_unit=vertical_unit,
        coordinate_unit=coordinate_unit,
        bin=bin,
        trace_weight=trace_weight,
        duplicates=duplicates,
        progress=progress,
    )


def synth(
    out: Value,
    *,
    size: Value | None = None,
    seed: Value | None = None,
    snr: Value | None = None,
    salt: bool = False,
    overturned: bool = False,
    progress: Progress | None = None,
) -> Answer:
    """Make a synthetic survey with its interpretation and its truth.

    Parameters
    ----------
    out : value
        Folder to write into; created if it does not exist.
    size : value, optional
        Inlines, crosslines and samples.
    seed : value, optional
        Seed of the random numbers that choose directions, beds and noise.
    snr : value, optional
        RMS signal over RMS noise; `none` for no noise.
    salt : bool
        With a dome of salt that overhangs and pierces the beds.
    overturned : bool
        Instead, an outcrop without seismic: nine horizons as scattered points with an overturned limb, three faults.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "synth",
        out,
        size=size,
        seed=seed,
        snr=snr,
        salt=salt,
        overturned=overturned,
        progress=progress,
    )


def info(
    path: Value,
    *,
    distortion: bool = False,
    inline_byte: Value | None = None,
    crossline_byte: Value | None = None,
    line_type: Value | None = None,
    line_numbers: Value | None = None,
    x_byte: Value | None = None,
    y_byte: Value | None = None,
    coordinate_type: Value | None = None,
    scalar_byte: Value | None = None,
    coordinate_scalar: Value | None = None,
    byte_order: Value | None = None,
    sample_format: Value | None = None,
    interval: Value | None = None,
    start: Value | None = None,
    vertical_unit: Value | None = None,
    coordinate_unit: Value | None = None,
    bin: Value | None = None,
    trace_weight: Value | None = None,
    duplicates: Value | None = None,
    format: Value | None = None,
    z_unit: Value | None = None,
    z_positive: Value | None = None,
    z_factor: Value | None = None,
    null: Value | None = None,
    select: Value | None = None,
    columns: Value | None = None,
    place_by: Value | None = None,
    value_order: Value | None = None,
    shape: Value | None = None,
    gap: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Show what a file or project holds.

    Parameters
    ----------
    path : value
        SEG-Y, horizon, fault or well file, or project folder.
    distortion : bool
        Of a project: compute how much patterns are distorted, layer by layer, on the faces of its first scene (or the
        default view) at vertical exaggeration 1.
    inline_byte : value, optional
        Trace header byte of the inline number.
    crossline_byte : value, optional
        Trace header byte of the crossline number.
    line_type : value, optional
        How line numbers are stored: i32, i16, u16, f32, f64 or ibm32 [default: i32, else what is found].
    line_numbers : value, optional
        Where line numbers come from: headers, coordinates (the lattice of X and Y, numbered from 1) or
        coordinates-swapped [default: headers].
    x_byte : value, optional
        Trace header byte of X.
    y_byte : value, optional
        Trace header byte of Y.
    coordinate_type : value, optional
        How X and Y are stored: i32, i16, u16, f32, f64 or ibm32 [default: i32, else f32 if that gives valid places].
    scalar_byte : value, optional
        Trace header byte of the coordinate scalar [default: 71].
    coordinate_scalar : value, optional
        Coordinate scalar, whatever the file holds: 10 multiplies by ten, -10 divides.
    byte_order : value, optional
        Byte order: big or little.
    sample_format : value, optional
        Sample format, whatever the header says: ibm32, ieee32, ieee64, int8, int16, int24, int32, int64, uint8, .
    interval : value, optional
        Sample interval, in the vertical unit.
    start : value, optional
        Value of the first sample, in the vertical unit.
    vertical_unit : value, optional
        Vertical unit: ms, m or ft.
    coordinate_unit : value, optional
        Unit of X and Y: m or ft.
    bin : value, optional
        Ignore X and Y: square bins of this size in metres, from 0, 0.
    trace_weight : value, optional
        Trace weight N at byte 169: apply (2^-N, the standard), inverse (2^N) or ignore [default: apply].
    duplicates : value, optional
        Which of several traces at one place to keep: first or last [default: first, if they are few].
    format : value, optional
        Format of the file [default: recognised].
    z_unit : value, optional
        Vertical unit of the file [default: as the file says, else the project's].
    z_positive : value, optional
        Direction in which the values of the file increase [default: as the file says, else down].
    z_factor : value, optional
        Factor that the file's values are multiplied by, before sign and unit are applied.
    null : value, optional
        Value that marks nodes without data.
    select : value, optional
        Name in the file, if it holds several.
    columns : value, optional
        Columns of a table in order, such as `inline,crossline,z` or `x,y,-,z`.
    place_by : value, optional
        What places points that have both line numbers and coordinates.
    value_order : value, optional
        CPS-3: the order of the values, columns from the north or rows from the south [default: the smoother].
    shape : value, optional
        A horizon as depths on a map, or of any shape (overturned limbs, closed bodies) [default: as its triangles or
        points are].
    gap : value, optional
        Scattered points: gaps that a circle of this radius fits into stay holes.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "info",
        path,
        distortion=distortion,
        inline_byte=inline_byte,
        crossline_byte=crossline_byte,
        line_type=line_type,
        line_numbers=line_numbers,
        x_byte=x_byte,
        y_byte=y_byte,
        coordinate_type=coordinate_type,
        scalar_byte=scalar_byte,
        coordinate_scalar=coordinate_scalar,
        byte_order=byte_order,
        sample_format=sample_format,
        interval=interval,
        start=start,
        vertical_unit=vertical_unit,
        coordinate_unit=coordinate_unit,
        bin=bin,
        trace_weight=trace_weight,
        duplicates=duplicates,
        format=format,
        z_unit=z_unit,
        z_positive=z_positive,
        z_factor=z_factor,
        null=null,
        select=select,
        columns=columns,
        place_by=place_by,
        value_order=value_order,
        shape=shape,
        gap=gap,
        progress=progress,
    )


def create(
    project: Value,
    *,
    bounds: Value | None = None,
    size: Value | None = None,
    inlines: Value | None = None,
    crosslines: Value | None = None,
    z_unit: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Create a project without seismic.

    Parameters
    ----------
    project : value
        Project folder to create, usually NAME.petro.
    bounds : value, optional
        World bounds X0,X1,Y0,Y1,Z0,Z1: X and Y in metres, Z in the vertical unit, positive down.
    size : value, optional
        Samples along X, Y and Z [default: 128x128x128].
    inlines : value, optional
        Numbers of the inlines, which count along X: FIRST,LAST or FIRST,LAST,STEP [default: from 1].
    crosslines : value, optional
        Numbers of the crosslines, which count along Y, in the same way.
    z_unit : value, optional
        Unit of Z: m or ms (two-way time) [default: m].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "create",
        project,
        bounds=bounds,
        size=size,
        inlines=inlines,
        crosslines=crosslines,
        z_unit=z_unit,
        progress=progress,
    )


def import_(
    survey: Value,
    project: Value,
    *,
    name: Value | None = None,
    polarity: Value | None = None,
    memory: Value | None = None,
    inline_byte: Value | None = None,
    crossline_byte: Value | None = None,
    line_type: Value | None = None,
    line_numbers: Value | None = None,
    x_byte: Value | None = None,
    y_byte: Value | None = None,
    coordinate_type: Value | None = None,
    scalar_byte: Value | None = None,
    coordinate_scalar: Value | None = None,
    byte_order: Value | None = None,
    sample_format: Value | None = None,
    interval: Value | None = None,
    start: Value | None = None,
    vertical_unit: Value | None = None,
    coordinate_unit: Value | None = None,
    bin: Value | None = None,
    trace_weight: Value | None = None,
    duplicates: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Read a SEG-Y volume into a project.

    Parameters
    ----------
    survey : value
        SEG-Y file, or folder of a volume that a project or the Python package has stored.
    project : value
        Project folder; created if it does not exist.
    name : value, optional
        Name of the volume [default: seismic, for further ones the file's name].
    polarity : value, optional
        What a positive amplitude means: normal (SEG: more impedance) or reverse.
    memory : value, optional
        Memory to use, such as 2G or 800M [default: half of what is available].
    inline_byte : value, optional
        Trace header byte of the inline number.
    crossline_byte : value, optional
        Trace header byte of the crossline number.
    line_type : value, optional
        How line numbers are stored: i32, i16, u16, f32, f64 or ibm32 [default: i32, else what is found].
    line_numbers : value, optional
        Where line numbers come from: headers, coordinates (the lattice of X and Y, numbered from 1) or
        coordinates-swapped [default: headers].
    x_byte : value, optional
        Trace header byte of X.
    y_byte : value, optional
        Trace header byte of Y.
    coordinate_type : value, optional
        How X and Y are stored: i32, i16, u16, f32, f64 or ibm32 [default: i32, else f32 if that gives valid places].
    scalar_byte : value, optional
        Trace header byte of the coordinate scalar [default: 71].
    coordinate_scalar : value, optional
        Coordinate scalar, whatever the file holds: 10 multiplies by ten, -10 divides.
    byte_order : value, optional
        Byte order: big or little.
    sample_format : value, optional
        Sample format, whatever the header says: ibm32, ieee32, ieee64, int8, int16, int24, int32, int64, uint8, .
    interval : value, optional
        Sample interval, in the vertical unit.
    start : value, optional
        Value of the first sample, in the vertical unit.
    vertical_unit : value, optional
        Vertical unit: ms, m or ft.
    coordinate_unit : value, optional
        Unit of X and Y: m or ft.
    bin : value, optional
        Ignore X and Y: square bins of this size in metres, from 0, 0.
    trace_weight : value, optional
        Trace weight N at byte 169: apply (2^-N, the standard), inverse (2^N) or ignore [default: apply].
    duplicates : value, optional
        Which of several traces at one place to keep: first or last [default: first, if they are few].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "import",
        survey,
        project,
        name=name,
        polarity=polarity,
        memory=memory,
        inline_byte=inline_byte,
        crossline_byte=crossline_byte,
        line_type=line_type,
        line_numbers=line_numbers,
        x_byte=x_byte,
        y_byte=y_byte,
        coordinate_type=coordinate_type,
        scalar_byte=scalar_byte,
        coordinate_scalar=coordinate_scalar,
        byte_order=byte_order,
        sample_format=sample_format,
        interval=interval,
        start=start,
        vertical_unit=vertical_unit,
        coordinate_unit=coordinate_unit,
        bin=bin,
        trace_weight=trace_weight,
        duplicates=duplicates,
        progress=progress,
    )


def attribute(
    project: Value,
    *,
    kind: Value | None = None,
    name: Value | None = None,
    volume: Value | None = None,
    max_dip: Value | None = None,
    memory: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Compute a volume from a volume: semblance, envelope or dip.

    Parameters
    ----------
    project : value
        Project folder.
    kind : value, optional
        Semblance (similarity of neighbouring traces, low at faults), envelope (strength of reflections), dip (their
        steepness); of geologic time, `petroglyph time` first, flattened (a Wheeler diagram: beds laid flat; empty
        where beds are missing) or hiatus (how fast it runs down the traces: high at unconformities).
    name : value, optional
        Name of the new volume; a dip adds NAME-inline and NAME-crossline.
    volume : value, optional
        Volume to compute it from [default: the first].
    max_dip : value, optional
        Steepest dip looked for, samples per line [default: 4].
    memory : value, optional
        Memory to use, such as 2G or 800M [default: half of what is available].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "attribute",
        project,
        kind=kind,
        name=name,
        volume=volume,
        max_dip=max_dip,
        memory=memory,
        progress=progress,
    )


def volume_list(
    project: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """List the volumes.

    Parameters
    ----------
    project : value
        Project folder.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "volume",
        "list",
        project,
        progress=progress,
    )


def volume_link(
    project: Value,
    url: Value,
    *,
    name: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Take in a volume that stays in object storage: its bricks are read, and cached, as they are needed.

    Parameters
    ----------
    project : value
        Project folder; made if there is none.
    url : value
        Address of the volume: s3://, gs://, az://, https://.
    name : value, optional
        Name of the volume [default: seismic, or the last part of the address].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "volume",
        "link",
        project,
        url,
        name=name,
        progress=progress,
    )


def volume_rename(
    project: Value,
    from_: Value,
    to: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Rename a volume.

    Parameters
    ----------
    project : value
        Project folder.
    from_ : value
        Volume.
    to : value
        New name.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "volume",
        "rename",
        project,
        from_,
        to,
        progress=progress,
    )


def volume_remove(
    project: Value,
    name: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Remove a volume.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Volume.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "volume",
        "remove",
        project,
        name,
        progress=progress,
    )


def horizon_add(
    project: Value,
    file: Value,
    *,
    name: Value | None = None,
    contact: Value | None = None,
    above: Value | None = None,
    below: Value | None = None,
    format: Value | None = None,
    z_unit: Value | None = None,
    z_positive: Value | None = None,
    z_factor: Value | None = None,
    null: Value | None = None,
    select: Value | None = None,
    columns: Value | None = None,
    place_by: Value | None = None,
    value_order: Value | None = None,
    shape: Value | None = None,
    gap: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Read a horizon.

    Parameters
    ----------
    project : value
        Project folder.
    file : value
        Horizon file.
    name : value, optional
        Name of the horizon.
    contact : value, optional
        How it meets its neighbours: conformable, erosional, onlap, intrusive, or truncated-intrusion (cut off by the
        erosion surfaces above it) [default: conformable].
    above : value, optional
        Put it just above this horizon [default: by its depth].
    below : value, optional
        Put it just below this horizon [default: by its depth].
    format : value, optional
        Format of the file [default: recognised].
    z_unit : value, optional
        Vertical unit of the file [default: as the file says, else the project's].
    z_positive : value, optional
        Direction in which the values of the file increase [default: as the file says, else down].
    z_factor : value, optional
        Factor that the file's values are multiplied by, before sign and unit are applied.
    null : value, optional
        Value that marks nodes without data.
    select : value, optional
        Name in the file, if it holds several.
    columns : value, optional
        Columns of a table in order, such as `inline,crossline,z` or `x,y,-,z`.
    place_by : value, optional
        What places points that have both line numbers and coordinates.
    value_order : value, optional
        CPS-3: the order of the values, columns from the north or rows from the south [default: the smoother].
    shape : value, optional
        A horizon as depths on a map, or of any shape (overturned limbs, closed bodies) [default: as its triangles or
        points are].
    gap : value, optional
        Scattered points: gaps that a circle of this radius fits into stay holes.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "horizon",
        "add",
        project,
        file,
        name=name,
        contact=contact,
        above=above,
        below=below,
        format=format,
        z_unit=z_unit,
        z_positive=z_positive,
        z_factor=z_factor,
        null=null,
        select=select,
        columns=columns,
        place_by=place_by,
        value_order=value_order,
        shape=shape,
        gap=gap,
        progress=progress,
    )


def horizon_list(
    project: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """List the horizons, youngest first.

    Parameters
    ----------
    project : value
        Project folder.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "horizon",
        "list",
        project,
        progress=progress,
    )


def horizon_show(
    project: Value,
    name: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Show what a horizon holds: depths, holes, sheets, source.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Horizon.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "horizon",
        "show",
        project,
        name,
        progress=progress,
    )


def horizon_rename(
    project: Value,
    from_: Value,
    to: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Rename a horizon.

    Parameters
    ----------
    project : value
        Project folder.
    from_ : value
        Horizon.
    to : value
        New name.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "horizon",
        "rename",
        project,
        from_,
        to,
        progress=progress,
    )


def horizon_draw(
    project: Value,
    name: Value,
    *,
    line: Values | None = None,
    snap: bool = False,
    colour: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Draw a line of a horizon by hand, where there is no candidate; it needs no extraction.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Horizon; created if it does not exist.
    line : value or values, optional
        Corners of the line: line numbers and the vertical value.
    snap : bool
        Lay its nodes on the nearest peak or trough, whichever the samples along the line are.
    colour : value, optional
        Colour of the horizon, #rrggbb [default: its present colour, or the next of a list].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "horizon",
        "draw",
        project,
        name,
        line=line,
        snap=snap,
        colour=colour,
        progress=progress,
    )


def horizon_track(
    project: Value,
    name: Value,
    *,
    at: Value | None = None,
    traces: Value | None = None,
    samples: Value | None = None,
    colour: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Track a reflection from one place within a window, never across a fault; it needs no extraction.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Horizon; created if it does not exist.
    at : value, optional
        Place on the reflection: line numbers and the vertical value.
    traces : value, optional
        Traces to each side of the place, 1 to 1000.
    samples : value, optional
        Samples above and below the place, 1 to 1000.
    colour : value, optional
        Colour of the horizon, #rrggbb [default: its present colour, or the next of a list].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "horizon",
        "track",
        project,
        name,
        at=at,
        traces=traces,
        samples=samples,
        colour=colour,
        progress=progress,
    )


def horizon_fill(
    project: Value,
    name: Value,
    *,
    max_traces: Value | None = None,
    along_reflection: bool = False,
    progress: Progress | None = None,
) -> Answer:
    """Fill the holes of a horizon, never across a fault.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Horizon.
    max_traces : value, optional
        Leave holes with more traces than this open [default: fill all].
    along_reflection : bool
        Follow the reflection through the holes where there is one, and fill the rest smoothly.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "horizon",
        "fill",
        project,
        name,
        max_traces=max_traces,
        along_reflection=along_reflection,
        progress=progress,
    )


def horizon_smooth(
    project: Value,
    name: Value,
    *,
    radius: Value | None = None,
    passes: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Smooth a horizon, never across a fault; one that was assembled stays smoothed when its picks change.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Horizon.
    radius : value, optional
        Traces to the farthest nodes that count, 0 to 50; 0 takes the smoothing of an assembled horizon back.
    passes : value, optional
        How often it is smoothed, 1 to 20.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "horizon",
        "smooth",
        project,
        name,
        radius=radius,
        passes=passes,
        progress=progress,
    )


def horizon_stack(
    project: Value,
    name: Value,
    *,
    count: Value | None = None,
    between: Values | None = None,
    spacing: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Add a stack of horizons: isochrons by geologic time, or surfaces at equal shares of the thickness between two.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        What the names of the horizons begin with; a number follows.
    count : value, optional
        Number of horizons.
    between : value or values, optional
        The horizon above and the horizon below [default: isochrons over all of the survey's rock].
    spacing : value, optional
        Isochrons (equal steps of geologic time, `petroglyph time` first) or proportional (equal shares of the
        thickness).
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "horizon",
        "stack",
        project,
        name,
        count=count,
        between=between,
        spacing=spacing,
        progress=progress,
    )


def horizon_replay(
    project: Value,
    name: Value | None = None,
    *,
    drop_unfit: bool = False,
    progress: Progress | None = None,
) -> Answer:
    """Make the picks of horizons again, after another extraction.

    Parameters
    ----------
    project : value
        Project folder.
    name : value, optional
        Horizon [default: all that were assembled].
    drop_unfit : bool
        Remove from the log the picks that no longer fit; a horizon that none fits stays as it was.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "horizon",
        "replay",
        project,
        *([] if name is None else [name]),
        drop_unfit=drop_unfit,
        progress=progress,
    )


def horizon_unpick(
    project: Value,
    id: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Remove a pick, or what was drawn or tracked, as if it had never been made.

    Parameters
    ----------
    project : value
        Project folder.
    id : value
        Number of the pick.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "horizon",
        "unpick",
        project,
        id,
        progress=progress,
    )


def horizon_colour(
    project: Value,
    name: Value,
    colour: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Give a horizon another colour.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Horizon.
    colour : value
        Colour, #rrggbb.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "horizon",
        "colour",
        project,
        name,
        colour,
        progress=progress,
    )


def horizon_contact(
    project: Value,
    name: Value,
    contact: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """State how a horizon meets its neighbours.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Horizon.
    contact : value
        Conformable, erosional, onlap, intrusive, or truncated-intrusion (cut off by younger erosion).
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "horizon",
        "contact",
        project,
        name,
        contact,
        progress=progress,
    )


def horizon_remove(
    project: Value,
    name: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Remove a horizon.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Horizon.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "horizon",
        "remove",
        project,
        name,
        progress=progress,
    )


def fault_add(
    project: Value,
    file: Value,
    *,
    name: Value | None = None,
    truncated_by: Value | None = None,
    extent: Values | None = None,
    format: Value | None = None,
    z_unit: Value | None = None,
    z_positive: Value | None = None,
    z_factor: Value | None = None,
    null: Value | None = None,
    select: Value | None = None,
    columns: Value | None = None,
    place_by: Value | None = None,
    value_order: Value | None = None,
    shape: Value | None = None,
    gap: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Read a fault.

    Parameters
    ----------
    project : value
        Project folder.
    file : value
        Fault file.
    name : value, optional
        Name of the fault.
    truncated_by : value, optional
        The fault it ends at.
    extent : value or values, optional
        How far it reaches beyond what was drawn: not at all, or so many metres on every side [default: drawn].
    format : value, optional
        Format of the file [default: recognised].
    z_unit : value, optional
        Vertical unit of the file [default: as the file says, else the project's].
    z_positive : value, optional
        Direction in which the values of the file increase [default: as the file says, else down].
    z_factor : value, optional
        Factor that the file's values are multiplied by, before sign and unit are applied.
    null : value, optional
        Value that marks nodes without data.
    select : value, optional
        Name in the file, if it holds several.
    columns : value, optional
        Columns of a table in order, such as `inline,crossline,z` or `x,y,-,z`.
    place_by : value, optional
        What places points that have both line numbers and coordinates.
    value_order : value, optional
        CPS-3: the order of the values, columns from the north or rows from the south [default: the smoother].
    shape : value, optional
        A horizon as depths on a map, or of any shape (overturned limbs, closed bodies) [default: as its triangles or
        points are].
    gap : value, optional
        Scattered points: gaps that a circle of this radius fits into stay holes.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "fault",
        "add",
        project,
        file,
        name=name,
        truncated_by=truncated_by,
        extent=extent,
        format=format,
        z_unit=z_unit,
        z_positive=z_positive,
        z_factor=z_factor,
        null=null,
        select=select,
        columns=columns,
        place_by=place_by,
        value_order=value_order,
        shape=shape,
        gap=gap,
        progress=progress,
    )


def fault_pick(
    project: Value,
    *,
    name: Value | None = None,
    stick: Values | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Draw a fault from sticks.

    Parameters
    ----------
    project : value
        Project folder.
    name : value, optional
        Name of the fault; if it exists already, the sticks are added to it.
    stick : value or values, optional
        A stick: two or more points along the fault, from top to bottom; repeat it for several.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "fault",
        "pick",
        project,
        name=name,
        stick=stick,
        progress=progress,
    )


def fault_move(
    project: Value,
    name: Value,
    *,
    stick: Value | None = None,
    point: Value | None = None,
    to: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Move a point of a stick that a fault was drawn with.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Fault.
    stick : value, optional
        Which of its sticks, counted from 1.
    point : value, optional
        Which of the stick's points, counted from 1.
    to : value, optional
        Inline, crossline, time or depth.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "fault",
        "move",
        project,
        name,
        stick=stick,
        point=point,
        to=to,
        progress=progress,
    )


def fault_propose(
    project: Value,
    *,
    reach: Value | None = None,
    min_throw: Value | None = None,
    min_dip: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Propose faults from the offsets of the horizons or, while there are none, from where candidates end.

    Parameters
    ----------
    project : value
        Project folder.
    reach : value, optional
        Largest distance between the two sides of a horizon, traces [default: 14].
    min_throw : value, optional
        Smallest throw, samples [default: 2].
    min_dip : value, optional
        Smallest dip, degrees [default: 30].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "fault",
        "propose",
        project,
        reach=reach,
        min_throw=min_throw,
        min_dip=min_dip,
        progress=progress,
    )


def fault_accept(
    project: Value,
    id: Value,
    *,
    name: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Accept a proposed fault.

    Parameters
    ----------
    project : value
        Project folder.
    id : value
        Number of the proposal.
    name : value, optional
        Name of the fault.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "fault",
        "accept",
        project,
        id,
        name=name,
        progress=progress,
    )


def fault_list(
    project: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """List the faults.

    Parameters
    ----------
    project : value
        Project folder.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "fault",
        "list",
        project,
        progress=progress,
    )


def fault_truncate(
    project: Value,
    name: Value,
    *,
    by: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """State at which other fault a fault ends.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Fault.
    by : value, optional
        The fault it ends at [default: none].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "fault",
        "truncate",
        project,
        name,
        by=by,
        progress=progress,
    )


def fault_extent(
    project: Value,
    name: Value,
    *extent: Value,
    progress: Progress | None = None,
) -> Answer:
    """State how far a fault reaches beyond what was drawn of it.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Fault.
    extent : value
        `drawn`, or `grow` and how many metres it reaches farther on every side.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "fault",
        "extent",
        project,
        name,
        *extent,
        progress=progress,
    )


def fault_colour(
    project: Value,
    name: Value,
    colour: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Give a fault another colour, on sections and on the block.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Fault.
    colour : value
        Colour, #rrggbb.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "fault",
        "colour",
        project,
        name,
        colour,
        progress=progress,
    )


def fault_rename(
    project: Value,
    from_: Value,
    to: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Rename a fault.

    Parameters
    ----------
    project : value
        Project folder.
    from_ : value
        Fault.
    to : value
        New name.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "fault",
        "rename",
        project,
        from_,
        to,
        progress=progress,
    )


def fault_remove(
    project: Value,
    name: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Remove a fault.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Fault.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "fault",
        "remove",
        project,
        name,
        progress=progress,
    )


def well_add(
    project: Value,
    deviation: Value,
    *,
    name: Value | None = None,
    tops: Value | None = None,
    las: Values | None = None,
    checkshot: Value | None = None,
    head: Value | None = None,
    kb: Value | None = None,
    md_unit: Value | None = None,
    well_in_file: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Read a well: its deviation, and tops, logs and checkshots along it.

    Parameters
    ----------
    project : value
        Project folder.
    deviation : value
        Deviation file.
    name : value, optional
        Name of the well.
    tops : value, optional
        Tops: names and depths.
    las : value or values, optional
        LAS 2.0 file; repeat it for several.
    checkshot : value, optional
        Time-depth table: TVDSS and TWT.
    head : value, optional
        X, Y of the well head in metres [default: as the deviation says].
    kb : value, optional
        Height of the datum (kelly bushing) above sea level in metres [default: as the deviation says].
    md_unit : value, optional
        Unit of depths whose columns do not state one [default: m].
    well_in_file : value, optional
        Name of the well in files that hold several [default: --name].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "well",
        "add",
        project,
        deviation,
        name=name,
        tops=tops,
        las=las,
        checkshot=checkshot,
        head=head,
        kb=kb,
        md_unit=md_unit,
        well_in_file=well_in_file,
        progress=progress,
    )


def well_list(
    project: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """List the wells.

    Parameters
    ----------
    project : value
        Project folder.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "well",
        "list",
        project,
        progress=progress,
    )


def well_show(
    project: Value,
    name: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Show where a well runs, where its tops lie relative to the horizons, and what was measured along it.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Well.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "well",
        "show",
        project,
        name,
        progress=progress,
    )


def well_colour(
    project: Value,
    name: Value,
    colour: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Give a well another colour, in the block and on sections.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Well.
    colour : value
        Colour, #rrggbb.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "well",
        "colour",
        project,
        name,
        colour,
        progress=progress,
    )


def well_rename(
    project: Value,
    from_: Value,
    to: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Rename a well.

    Parameters
    ----------
    project : value
        Project folder.
    from_ : value
        Well.
    to : value
        New name.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "well",
        "rename",
        project,
        from_,
        to,
        progress=progress,
    )


def well_remove(
    project: Value,
    name: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Remove a well.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Well.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "well",
        "remove",
        project,
        name,
        progress=progress,
    )


def extract(
    project: Value,
    *,
    volume: Value | None = None,
    memory: Value | None = None,
    method: Value | None = None,
    extrema: Value | None = None,
    min_front_width: Value | None = None,
    join_share: Value | None = None,
    fault_evidence: Value | None = None,
    min_leaf_triangles: Value | None = None,
    max_distance: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Find horizon candidates in a volume: surfaces, their trees, and the closest leaf of every voxel.

    Parameters
    ----------
    project : value
        Project folder.
    volume : value, optional
        Volume to extract from [default: the first on the project's lattice].
    memory : value, optional
        Memory to use, such as 4G: what takes more in one piece (31 bytes a voxel) is done in bricks, with the same
        result; a killed one goes on when it is started again [default: half of what is available].
    method : value, optional
        How surfaces grow: `ours`, or `paper` for the published method.
    extrema : value, optional
        What surfaces follow: peak, trough or zero; separate several by commas.
    min_front_width : value, optional
        Smallest width, traces: surfaces and connections narrower than this are not grown.
    join_share : value, optional
        Share of the common boundary of two pieces of a surface that must support joining them: a smaller share gives
        fewer and larger surfaces; more than 1 joins none.
    fault_evidence : value, optional
        Evidence required along a plane to count it as a fault, which cuts surfaces: a larger value gives fewer cuts.
        Use 100 to 200 for chaotic or clipped data; `inf` looks for no faults.
    min_leaf_triangles : value, optional
        Smallest number of triangles in a leaf of a surface's tree.
    max_distance : value, optional
        Largest distance to a surface that is stored, voxels.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "extract",
        project,
        volume=volume,
        memory=memory,
        method=method,
        extrema=extrema,
        min_front_width=min_front_width,
        join_share=join_share,
        fault_evidence=fault_evidence,
        min_leaf_triangles=min_leaf_triangles,
        max_distance=max_distance,
        progress=progress,
    )


def time(
    project: Value,
    *,
    name: Value | None = None,
    memory: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Compute geologic time: a volume in which every bed has one value, also beyond faults.

    Parameters
    ----------
    project : value
        Project folder.
    name : value, optional
        Name of the new volume.
    memory : value, optional
        Memory to use beside the candidates, such as 2G or 800M [default: half of what is available]; a survey that
        needs more is solved in slabs of inlines that are joined.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "time",
        project,
        name=name,
        memory=memory,
        progress=progress,
    )


def pick(
    project: Value,
    *,
    at: Value | None = None,
    horizon: Value | None = None,
    up: Value | None = None,
    highest_valid: bool = False,
    by_time: bool = False,
    remove: bool = False,
    colour: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Pick a candidate and add it to a horizon, or take it out; or add the level of geologic time through a place.

    Parameters
    ----------
    project : value
        Project folder.
    at : value, optional
        Place: line numbers and the vertical value.
    horizon : value, optional
        Horizon to add the node to; created if it does not exist.
    up : value, optional
        Climb this many levels above the leaf [default: 0].
    highest_valid : bool
        Climb to the highest node that is a single sheet: at most 2 % of its points lie over itself, as noise leaves
        them, and are left out of the horizon; at most 10 % lie over the rest of the horizon, as beside a fault that
        is not drawn, which is then said.
    by_time : bool
        Add a new horizon that is the level of geologic time through the place, over the whole survey and across its
        faults, or correct one that was made so around the place; `petroglyph time` first.
    remove : bool
        Remove the node from the horizon.
    colour : value, optional
        Colour of the horizon, #rrggbb [default: its present colour, or the next of a list].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "pick",
        project,
        at=at,
        horizon=horizon,
        up=up,
        highest_valid=highest_valid,
        by_time=by_time,
        remove=remove,
        colour=colour,
        progress=progress,
    )


def climb(
    project: Value,
    id: Value,
    *,
    levels: Value | None = None,
    highest_valid: bool = False,
    progress: Progress | None = None,
) -> Answer:
    """Move a pick up its tree.

    Parameters
    ----------
    project : value
        Project folder.
    id : value
        Number of the pick.
    levels : value, optional
        Levels.
    highest_valid : bool
        Climb to the highest node that is a single sheet: at most 2 % of its points lie over itself, as noise leaves
        them, and are left out of the horizon; at most 10 % lie over the rest of it, which is then said.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "climb",
        project,
        id,
        levels=levels,
        highest_valid=highest_valid,
        progress=progress,
    )


def descend(
    project: Value,
    id: Value,
    *,
    levels: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Move a pick down its tree.

    Parameters
    ----------
    project : value
        Project folder.
    id : value
        Number of the pick.
    levels : value, optional
        Levels.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "descend",
        project,
        id,
        levels=levels,
        progress=progress,
    )


def evaluate(
    project: Value,
    truth: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Measure the extraction against the truth of a synthetic survey.

    Parameters
    ----------
    project : value
        Project folder.
    truth : value
        Folder that `petroglyph synth` wrote.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "evaluate",
        project,
        truth,
        progress=progress,
    )


def export(
    project: Value,
    out: Value,
    *,
    horizon: Value | None = None,
    fault: Value | None = None,
    candidates: bool = False,
    format: Value | None = None,
    values: Values | None = None,
    window: Value | None = None,
    volume: Value | None = None,
    format_code: Value | None = None,
    when_rotated: Value | None = None,
    model: bool = False,
    scene: Value | None = None,
    triangles: Value | None = None,
    density: Value | None = None,
    device: Value | None = None,
    volume_memory: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Write a horizon, a fault, the points of all candidates, a volume or a 3D model to a file, or a volume to object
    storage.

    Parameters
    ----------
    project : value
        Project folder.
    out : value
        File to write; for a volume also an address in object storage: s3://, gs://, az://, https://.
    horizon : value, optional
        Horizon to write.
    fault : value, optional
        Fault to write, as opendtect (sticks) or tsurf (triangles).
    candidates : bool
        Write all horizon candidates instead, as CSV with inline, crossline, z, leaf and surface of each point.
    format : value, optional
        Format of the file: csv, irap, opendtect, tsurf, zmap or cps3 [default: by its extension].
    values : value or values, optional
        Write the values of these volumes at the horizon's nodes, as CSV.
    window : value, optional
        With --values: also their mean, root mean square and greatest magnitude over so many samples above and below.
    volume : value, optional
        Volume to write as SEG-Y.
    format_code : value, optional
        SEG-Y sample format: 1 IBM float, 3 16-bit integer, 5 IEEE float, 8 8-bit integer, 11 and 16 unsigned 16-bit
        and 8-bit integer [default: as the volume is stored].
    when_rotated : value, optional
        ZMAP+ and CPS-3, which hold no rotated grids: resample such a grid, or refuse it [default: resample].
    model : bool
        Write the block as a 3D model for slides (.glb): faces with their pictures, horizons, faults, wells.
    scene : value, optional
        Scene whose block is the model [default: the first of the project, or the default view].
    triangles : value, optional
        Most triangles of the model; Office takes 100000.
    density : value, optional
        Texels along the longest side of the model's block.
    device : value, optional
        Device that draws: the graphics adapter, or the processor when there is none (auto), or one of the two.
    volume_memory : value, optional
        Largest memory for the samples of one volume, such as 2G; a larger volume is shown at a coarser level of its
        pyramid [default: half of what is free].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "export",
        project,
        out,
        horizon=horizon,
        fault=fault,
        candidates=candidates,
        format=format,
        values=values,
        window=window,
        volume=volume,
        format_code=format_code,
        when_rotated=when_rotated,
        model=model,
        scene=scene,
        triangles=triangles,
        density=density,
        device=device,
        volume_memory=volume_memory,
        progress=progress,
    )


def velocity(
    project: Value,
    velocity_m_s: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """State the velocity that turns two-way time into metres.

    Parameters
    ----------
    project : value
        Project folder.
    velocity_m_s : value
        Velocity, m/s.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "velocity",
        project,
        velocity_m_s,
        progress=progress,
    )


def layer_list(
    project: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """List the layers, youngest first, with their style.

    Parameters
    ----------
    project : value
        Project folder.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "layer",
        "list",
        project,
        progress=progress,
    )


def layer_set(
    project: Value,
    layer: Value,
    *,
    name: Value | None = None,
    pattern: Value | None = None,
    rock: Value | None = None,
    age: Value | None = None,
    colour: Value | None = None,
    ink: Value | None = None,
    frequency: Value | None = None,
    opacity: Value | None = None,
    k: Value | None = None,
    interval: Values | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Change how a layer looks.

    Parameters
    ----------
    project : value
        Project folder.
    layer : value
        Layer, as `layer list` names it.
    name : value, optional
        New name.
    pattern : value, optional
        Pattern over the whole layer (`petroglyph patterns` draws them all); sets its usual colour, too.
    rock : value, optional
        Rock, whose pattern and usual colour the layer takes: a term of the CGI simple lithology vocabulary (`alkali
        olivine basalt`), or words that end in one (`oolitic limestone`).
    age : value, optional
        Unit of geological time, whose colour on the international chart the layer takes (`Campanian`).
    colour : value, optional
        Colour under the pattern.
    ink : value, optional
        Colour of the pattern's lines.
    frequency : value, optional
        Repeats of the tile across the block and through the layer.
    opacity : value, optional
        Opacity inside a cut-out, 0 to 1.
    k : value, optional
        How the pattern runs through the layer: flow (the smoothest way between its horizons, the default but below an
        erosion surface, where it is parallel-to-bottom, and above an onlap surface, where it is parallel-to-top),
        harmonic (the same by the letter of ∇²k = 0 in the top and bottom layer and between horizons of any shape,
        too), distance (the ratio of distances to both, as published; follows every wiggle), proportional (the
        vertical fraction), parallel-to-bottom or parallel-to-top.
    interval : value or values, optional
        Pattern of a part of the layer's depth, 0 at the base to 1 at the top; repeat it for each part.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "layer",
        "set",
        project,
        layer,
        name=name,
        pattern=pattern,
        rock=rock,
        age=age,
        colour=colour,
        ink=ink,
        frequency=frequency,
        opacity=opacity,
        k=k,
        interval=interval,
        progress=progress,
    )


def layer_reset(
    project: Value,
    layer: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Give a layer its default style again.

    Parameters
    ----------
    project : value
        Project folder.
    layer : value
        Layer.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "layer",
        "reset",
        project,
        layer,
        progress=progress,
    )


def scalar_list(
    project: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """List the textures laid over the layers by the values of volumes.

    Parameters
    ----------
    project : value
        Project folder.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "scalar",
        "list",
        project,
        progress=progress,
    )


def scalar_set(
    project: Value,
    volume: Value,
    *,
    interval: Values | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Lay textures over the layers where a volume's values lie in a range.

    Parameters
    ----------
    project : value
        Project folder.
    volume : value
        Volume.
    interval : value or values, optional
        Range of values, pattern, its opacity, and factors on the layer's frequencies; repeat it for each range.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "scalar",
        "set",
        project,
        volume,
        interval=interval,
        progress=progress,
    )


def scalar_remove(
    project: Value,
    volume: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Remove the textures of a volume.

    Parameters
    ----------
    project : value
        Project folder.
    volume : value
        Volume.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "scalar",
        "remove",
        project,
        volume,
        progress=progress,
    )


def raw(
    project: Value,
    *,
    volume: Value | None = None,
    map: Value | None = None,
    range: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Choose which volume is shown as raw data, and in which colours.

    Parameters
    ----------
    project : value
        Project folder.
    volume : value, optional
        Volume to show [default: the one shown at present, else the first].
    map : value, optional
        Colour map: seismics, petrel-like, red-white-black, grey, cool-warm, strata.
    range : value, optional
        Values of the first and the last colour [default: plus and minus the 99th percentile].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "raw",
        project,
        volume=volume,
        map=map,
        range=range,
        progress=progress,
    )


def texture(
    project: Value,
    file: Value,
    *,
    width_mm: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Add a tile of your own to a project.

    Parameters
    ----------
    project : value
        Project folder.
    file : value
        PNG, JPEG or SVG tile; layers refer to it by the file's name without extension.
    width_mm : value, optional
        Printed width of the tile.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "texture",
        project,
        file,
        width_mm=width_mm,
        progress=progress,
    )


def scene_list(
    project: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """List the named scenes.

    Parameters
    ----------
    project : value
        Project folder.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "scene",
        "list",
        project,
        progress=progress,
    )


def scene_add(
    project: Value,
    name: Value,
    *,
    from_: Value | None = None,
    size: Value | None = None,
    blend: Value | None = None,
    lookup: Value | None = None,
    exaggeration: Value | None = None,
    azimuth: Value | None = None,
    elevation: Value | None = None,
    perspective: Value | None = None,
    zoom: Value | None = None,
    box: Value | None = None,
    cut: Values | None = None,
    cut_box: Values | None = None,
    cut_fence: Values | None = None,
    cut_side: Value | None = None,
    cut_smooth: bool = False,
    cut_round: Values | None = None,
    cut_depth: Value | None = None,
    cut_plane: Values | None = None,
    ground: Value | None = None,
    ground_opacity: Value | None = None,
    water: Value | None = None,
    show: Value | None = None,
    level: Value | None = None,
    outlines: Value | None = None,
    global_frequency: Value | None = None,
    pattern_size: Value | None = None,
    preset: Value | None = None,
    samples: Value | None = None,
    background: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Save a scene under a name.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Name of the scene.
    from_ : value, optional
        TOML file to start from, as `scene show` prints it.
    size : value, optional
        Size of the image in pixels.
    blend : value, optional
        Blend from 0 = illustrative to 1 = raw data.
    lookup : value, optional
        How layer coordinates are looked up: exact, or the packed volume of the published method.
    exaggeration : value, optional
        Vertical exaggeration.
    azimuth : value, optional
        Bearing in which the camera looks, degrees clockwise from north.
    elevation : value, optional
        Height of the camera above the horizontal, degrees.
    perspective : value, optional
        Use a perspective with this opening angle instead of a parallel projection.
    zoom : value, optional
        Magnification, as a factor on the scale at which the block fits the image.
    box : value, optional
        Show only this part of the survey: inlines, crosslines, vertical values.
    cut : value or values, optional
        Cut a corner off over the whole height: nearest, min-min, min-max, max-min or max-max (first and last inline,
        crossline), and the share of the block's length along inlines and crosslines; repeat it for several.
    cut_box : value or values, optional
        Cut a box out; repeat it for several.
    cut_fence : value or values, optional
        Cut everything away that lies before a wall on a line with these corners, two or more: line numbers, or
        well:NAME for the head of a well. The line's ends go on straight.
    cut_side : value, optional
        The side of --cut-fence that is cut away, seen along the line on a map with inlines' indices to the right and
        crosslines' upwards [default: the viewer's].
    cut_smooth : bool
        Lead a curve through the corners of --cut-fence.
    cut_round : value or values, optional
        Cut a round shaft: inline, crossline, radius in metres; repeat it for several.
    cut_depth : value, optional
        Limit --cut-fence and --cut-round to these vertical values.
    cut_plane : value or values, optional
        Cut everything away above a plane through a place: inline, crossline, vertical value, bearing of its dip and
        dip in degrees; repeat it for several.
    ground : value, optional
        Show the relief of the topmost horizon instead of a flat top.
    ground_opacity : value, optional
        Opacity of that relief.
    water : value, optional
        Fill what lies above that relief with water, up to this depth or time, to which the block reaches at least;
        ground above it stays dry; `off`: air.
    show : value, optional
        What faces show: the rock, the leaves of horizon candidates in colours, the distance to the nearest candidate,
        or how much patterns are distorted (white: not; blue: too dense or narrow; orange: too sparse or wide), with
        the shares of area printed. In volume rendering, leaves colour the horizons shown, or all candidates.
    level : value, optional
        Colour leaves by the node this many levels up their surface tree; 0 = the leaf itself. Shows leaves unless
        --show says otherwise.
    outlines : value, optional
        Draw lines along horizons, faults and edges; dashed: dashed on the block where a horizon was not picked, but
        filled or extrapolated (sections and fences always are).
    global_frequency : value, optional
        Factor on the frequency of every pattern.
    pattern_size : value, optional
        What patterns are fixed to in a close-up: to the rock, so that they grow with it, or to the paper, so that
        they keep the size that they have where the whole survey fits the picture.
    preset : value, optional
        Colours, black patterns on white, or shades of grey. What is measured stays in shades of grey where there are
        no colours.
    samples : value, optional
        Samples per pixel along each axis.
    background : value, optional
        Colour behind the block, or `transparent`.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "scene",
        "add",
        project,
        name,
        from_=from_,
        size=size,
        blend=blend,
        lookup=lookup,
        exaggeration=exaggeration,
        azimuth=azimuth,
        elevation=elevation,
        perspective=perspective,
        zoom=zoom,
        box=box,
        cut=cut,
        cut_box=cut_box,
        cut_fence=cut_fence,
        cut_side=cut_side,
        cut_smooth=cut_smooth,
        cut_round=cut_round,
        cut_depth=cut_depth,
        cut_plane=cut_plane,
        ground=ground,
        ground_opacity=ground_opacity,
        water=water,
        show=show,
        level=level,
        outlines=outlines,
        global_frequency=global_frequency,
        pattern_size=pattern_size,
        preset=preset,
        samples=samples,
        background=background,
        progress=progress,
    )


def scene_show(
    project: Value,
    name: Value | None = None,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Print a scene as TOML, to edit and give to `render --scene` or `scene add --from`.

    Parameters
    ----------
    project : value
        Project folder.
    name : value, optional
        Name of the scene [default: the one that `render` starts from].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "scene",
        "show",
        project,
        *([] if name is None else [name]),
        progress=progress,
    )


def scene_rename(
    project: Value,
    from_: Value,
    to: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Rename a scene.

    Parameters
    ----------
    project : value
        Project folder.
    from_ : value
        Name of the scene.
    to : value
        New name.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "scene",
        "rename",
        project,
        from_,
        to,
        progress=progress,
    )


def scene_remove(
    project: Value,
    name: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Remove a scene.

    Parameters
    ----------
    project : value
        Project folder.
    name : value
        Name of the scene.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "scene",
        "remove",
        project,
        name,
        progress=progress,
    )


def parameterize(
    project: Value,
    *,
    from_: Value | None = None,
    by_time: bool = False,
    computed: bool = False,
    size: Value | None = None,
    memory: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Compute the layer coordinates i, j, k and keep them in the project.

    Parameters
    ----------
    project : value
        Project folder.
    from_ : value, optional
        Take i, j, k from a Zarr v3 group that another program wrote, instead of computing them: arrays i, j, k
        (float32, NaN outside), layer (0 = deepest) and block (uint8 or uint16), by inline, crossline and sample over
        the whole survey.
    by_time : bool
        Take k between two horizons from geologic time, as its fraction between theirs: textures follow every bed
        (`petroglyph time` first).
    computed : bool
        Compute i, j, k here again, after --from or --by-time.
    size : value, optional
        Samples of the stored arrays along inlines, crosslines and depth [default: the survey's].
    memory : value, optional
        Memory to use beside the model and its grids, such as 2G or 800M: fewer threads sample at a time; the arrays
        are the same [default: 64M for each thread].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "parameterize",
        project,
        from_=from_,
        by_time=by_time,
        computed=computed,
        size=size,
        memory=memory,
        progress=progress,
    )


def render(
    project: Value,
    out: Value,
    *,
    scene: Value | None = None,
    dpi: Value | None = None,
    technique: Value | None = None,
    medium: Value | None = None,
    clear_below: Value | None = None,
    horizon: Values | None = None,
    isosurface: Values | None = None,
    scope: Value | None = None,
    device: Value | None = None,
    volume_memory: Value | None = None,
    inline: Values | None = None,
    crossline: Values | None = None,
    slice: Values | None = None,
    proportions: Value | None = None,
    section_blend: Value | None = None,
    fence: Values | None = None,
    map: Value | None = None,
    thickness_to: Value | None = None,
    correlation: Values | None = None,
    datum: Value | None = None,
    log: Values | None = None,
    well_range: Value | None = None,
    block: bool = False,
    compare: Value | None = None,
    wipe: Value | None = None,
    interpretation: bool = False,
    legend: bool = False,
    scale_bar: bool = False,
    north_arrow: bool = False,
    annotate: Values | None = None,
    credit: Value | None = None,
    font: Values | None = None,
    title: Value | None = None,
    caption: Value | None = None,
    size_cm: Value | None = None,
    figure: Value | None = None,
    size: Value | None = None,
    blend: Value | None = None,
    lookup: Value | None = None,
    exaggeration: Value | None = None,
    azimuth: Value | None = None,
    elevation: Value | None = None,
    perspective: Value | None = None,
    zoom: Value | None = None,
    box: Value | None = None,
    cut: Values | None = None,
    cut_box: Values | None = None,
    cut_fence: Values | None = None,
    cut_side: Value | None = None,
    cut_smooth: bool = False,
    cut_round: Values | None = None,
    cut_depth: Value | None = None,
    cut_plane: Values | None = None,
    ground: Value | None = None,
    ground_opacity: Value | None = None,
    water: Value | None = None,
    show: Value | None = None,
    level: Value | None = None,
    outlines: Value | None = None,
    global_frequency: Value | None = None,
    pattern_size: Value | None = None,
    preset: Value | None = None,
    samples: Value | None = None,
    background: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Draw a picture.

    Parameters
    ----------
    project : value
        Project folder.
    out : value
        File to write: .png or .tif for pixels, .svg or .pdf for paths and text.
    scene : value, optional
        Named scene of the project, or a TOML file [default: the project's first, else a three-quarter view].
    dpi : value, optional
        Resolution written into the picture, dots per inch; it sets the printed size.
    technique : value, optional
        Technique: illustrate (textured faces), volume rendering as occlusion (shaded without gradients), phong
        (shaded by gradients), interleaved (both, in stripes) or volume (unshaded), or map (a map of the topmost
        horizon unless --map names one) [default: as the scene says, else illustrate].
    medium : value, optional
        Volume that volume rendering shows; with textured faces it fills the cut-outs, in the layers that have an
        opacity if there are any [default: the volume shown as raw data].
    clear_below : value, optional
        Values up to this share of the volume's clip are transparent, larger ones increasingly opaque; from -1.
    horizon : value or values, optional
        Horizon shown in the volume, with its colour, opacity and the light it gives off; repeat it for several.
    isosurface : value or values, optional
        Isosurface: of a volume by its name, or of `k`, which is the number of the layer from the bottom (counted from
        0) plus k; without --medium the volume itself is not shown; repeat it for several.
    scope : value, optional
        Where the volume shows: everywhere, near the horizons shown, or away from them.
    device : value, optional
        Device that draws: the graphics adapter, or the processor when there is none (auto), or one of the two.
    volume_memory : value, optional
        Largest memory for the samples of one volume, such as 2G; a larger volume is shown at a coarser level of its
        pyramid [default: half of what is free].
    inline : value or values, optional
        Section along this inline; repeat it for several.
    crossline : value or values, optional
        Section along this crossline; repeat it for several.
    slice : value or values, optional
        Horizontal section at this time or depth; repeat it for several.
    proportions : value, optional
        Proportions of sections along inlines and crosslines, vertical to horizontal [default: they fill their room].
    section_blend : value, optional
        What sections and fences show: 0 the rock with its patterns, 1 measured data, or a mixture [default: measured
        data where there are some].
    fence : value or values, optional
        Section along a line with these corners, two or more.
    map : value, optional
        Map of a horizon: its depth or time in colours and contours.
    thickness_to : value, optional
        Map the thickness from the horizon of --map down to this one instead.
    correlation : value or values, optional
        Wells side by side, their tops joined by lines: from left to right, or all wells of the project in its order.
    datum : value, optional
        Draw the wells of --correlation so that this top or horizon is level.
    log : value or values, optional
        Curve beside each well of --correlation, or none; repeat it for several [default: the one that most wells
        have].
    well_range : value, optional
        First and last depth or time of --correlation, from --datum if there is one [default: whole wells].
    block : bool
        Add the block, beside the sections or the map that were asked for.
    compare : value, optional
        Two blocks compared: their blends, 0 = illustrated to 1 = raw.
    wipe : value, optional
        Lay the two blocks over one another, divided at this share of the width, instead of side by side.
    interpretation : bool
        Show what an interpreter sees: horizons as they were picked with dotted holes, faults, proposals and sticks.
    legend : bool
        List the layers with their patterns, or the horizons with their colours.
    scale_bar : bool
        Draw scale bars and state the vertical exaggeration.
    north_arrow : bool
        Draw a north arrow below the block, as it lies in the block's middle.
    annotate : value or values, optional
        Write on blocks and sections: axes (inlines, crosslines, depth or time along the edges), layers (names along
        the layers), faults (names, measured throw, half-arrows), wells (names of wells and tops), quality (horizons
        dashed where they were filled, in short dashes with question marks where they were only continued), colours (a
        bar of the raw data's values), provenance (program, project, --credit); all adds the legend, the scale bars
        and the north arrow.
    credit : value, optional
        Whose data the figure shows, for the line of provenance.
    font : value or values, optional
        Font file (.ttf, .otf, .ttc) for names in letters that the embedded face lacks, such as Arabic or Chinese;
        repeat it for several. NAME.ttc#2 is the third face of a collection.
    title : value, optional
        Title above the figure.
    caption : value, optional
        Caption below the figure, broken into lines.
    size_cm : value, optional
        Size of the page on paper, in centimetres at --dpi.
    figure : value, optional
        TOML file that says what the page shows, instead of the other options of the page.
    size : value, optional
        Size of the image in pixels.
    blend : value, optional
        Blend from 0 = illustrative to 1 = raw data.
    lookup : value, optional
        How layer coordinates are looked up: exact, or the packed volume of the published method.
    exaggeration : value, optional
        Vertical exaggeration.
    azimuth : value, optional
        Bearing in which the camera looks, degrees clockwise from north.
    elevation : value, optional
        Height of the camera above the horizontal, degrees.
    perspective : value, optional
        Use a perspective with this opening angle instead of a parallel projection.
    zoom : value, optional
        Magnification, as a factor on the scale at which the block fits the image.
    box : value, optional
        Show only this part of the survey: inlines, crosslines, vertical values.
    cut : value or values, optional
        Cut a corner off over the whole height: nearest, min-min, min-max, max-min or max-max (first and last inline,
        crossline), and the share of the block's length along inlines and crosslines; repeat it for several.
    cut_box : value or values, optional
        Cut a box out; repeat it for several.
    cut_fence : value or values, optional
        Cut everything away that lies before a wall on a line with these corners, two or more: line numbers, or
        well:NAME for the head of a well. The line's ends go on straight.
    cut_side : value, optional
        The side of --cut-fence that is cut away, seen along the line on a map with inlines' indices to the right and
        crosslines' upwards [default: the viewer's].
    cut_smooth : bool
        Lead a curve through the corners of --cut-fence.
    cut_round : value or values, optional
        Cut a round shaft: inline, crossline, radius in metres; repeat it for several.
    cut_depth : value, optional
        Limit --cut-fence and --cut-round to these vertical values.
    cut_plane : value or values, optional
        Cut everything away above a plane through a place: inline, crossline, vertical value, bearing of its dip and
        dip in degrees; repeat it for several.
    ground : value, optional
        Show the relief of the topmost horizon instead of a flat top.
    ground_opacity : value, optional
        Opacity of that relief.
    water : value, optional
        Fill what lies above that relief with water, up to this depth or time, to which the block reaches at least;
        ground above it stays dry; `off`: air.
    show : value, optional
        What faces show: the rock, the leaves of horizon candidates in colours, the distance to the nearest candidate,
        or how much patterns are distorted (white: not; blue: too dense or narrow; orange: too sparse or wide), with
        the shares of area printed. In volume rendering, leaves colour the horizons shown, or all candidates.
    level : value, optional
        Colour leaves by the node this many levels up their surface tree; 0 = the leaf itself. Shows leaves unless
        --show says otherwise.
    outlines : value, optional
        Draw lines along horizons, faults and edges; dashed: dashed on the block where a horizon was not picked, but
        filled or extrapolated (sections and fences always are).
    global_frequency : value, optional
        Factor on the frequency of every pattern.
    pattern_size : value, optional
        What patterns are fixed to in a close-up: to the rock, so that they grow with it, or to the paper, so that
        they keep the size that they have where the whole survey fits the picture.
    preset : value, optional
        Colours, black patterns on white, or shades of grey. What is measured stays in shades of grey where there are
        no colours.
    samples : value, optional
        Samples per pixel along each axis.
    background : value, optional
        Colour behind the block, or `transparent`.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "render",
        project,
        out,
        scene=scene,
        dpi=dpi,
        technique=technique,
        medium=medium,
        clear_below=clear_below,
        horizon=horizon,
        isosurface=isosurface,
        scope=scope,
        device=device,
        volume_memory=volume_memory,
        inline=inline,
        crossline=crossline,
        slice=slice,
        proportions=proportions,
        section_blend=section_blend,
        fence=fence,
        map=map,
        thickness_to=thickness_to,
        correlation=correlation,
        datum=datum,
        log=log,
        well_range=well_range,
        block=block,
        compare=compare,
        wipe=wipe,
        interpretation=interpretation,
        legend=legend,
        scale_bar=scale_bar,
        north_arrow=north_arrow,
        annotate=annotate,
        credit=credit,
        font=font,
        title=title,
        caption=caption,
        size_cm=size_cm,
        figure=figure,
        size=size,
        blend=blend,
        lookup=lookup,
        exaggeration=exaggeration,
        azimuth=azimuth,
        elevation=elevation,
        perspective=perspective,
        zoom=zoom,
        box=box,
        cut=cut,
        cut_box=cut_box,
        cut_fence=cut_fence,
        cut_side=cut_side,
        cut_smooth=cut_smooth,
        cut_round=cut_round,
        cut_depth=cut_depth,
        cut_plane=cut_plane,
        ground=ground,
        ground_opacity=ground_opacity,
        water=water,
        show=show,
        level=level,
        outlines=outlines,
        global_frequency=global_frequency,
        pattern_size=pattern_size,
        preset=preset,
        samples=samples,
        background=background,
        progress=progress,
    )


def figures(
    project: Value,
    out: Value,
    *,
    font: Values | None = None,
    device: Value | None = None,
    volume_memory: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Make all figures that the project lists as `figures` in its project.toml.

    Parameters
    ----------
    project : value
        Project folder.
    out : value
        Folder to write into; created if it does not exist. Files of the figures' names are replaced, others stay.
    font : value or values, optional
        Font file for names in letters that the embedded face and the project's own fonts lack; repeat it for several.
    device : value, optional
        Device that draws: the graphics adapter, or the processor when there is none (auto), or one of the two.
    volume_memory : value, optional
        Largest memory for the samples of one volume, such as 2G; a larger volume is shown at a coarser level of its
        pyramid [default: half of what is free].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "figures",
        project,
        out,
        font=font,
        device=device,
        volume_memory=volume_memory,
        progress=progress,
    )


def animate(
    project: Value,
    out: Value,
    *,
    scene: Value | None = None,
    motion: Value | None = None,
    turn: Value | None = None,
    along: Value | None = None,
    to: Value | None = None,
    frames: Value | None = None,
    rate: Value | None = None,
    once: bool = False,
    device: Value | None = None,
    volume_memory: Value | None = None,
    size: Value | None = None,
    blend: Value | None = None,
    lookup: Value | None = None,
    exaggeration: Value | None = None,
    azimuth: Value | None = None,
    elevation: Value | None = None,
    perspective: Value | None = None,
    zoom: Value | None = None,
    box: Value | None = None,
    cut: Values | None = None,
    cut_box: Values | None = None,
    cut_fence: Values | None = None,
    cut_side: Value | None = None,
    cut_smooth: bool = False,
    cut_round: Values | None = None,
    cut_depth: Value | None = None,
    cut_plane: Values | None = None,
    ground: Value | None = None,
    ground_opacity: Value | None = None,
    water: Value | None = None,
    show: Value | None = None,
    level: Value | None = None,
    outlines: Value | None = None,
    global_frequency: Value | None = None,
    pattern_size: Value | None = None,
    preset: Value | None = None,
    samples: Value | None = None,
    background: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Draw an animation: around the block, from illustration to raw data, through the block, or between two scenes.

    Parameters
    ----------
    project : value
        Project folder.
    out : value
        File to write (.png: animated PNG, .gif: GIF), or a new folder for numbered frames (0001.png, 0002.png, …),
        from which other programs make films.
    scene : value, optional
        Named scene of the project to start from, or a TOML file [default: the project's first, else a three-quarter
        view].
    motion : value, optional
        What moves: the camera around the block, the blend from illustration to raw data, a section through the block,
        or everything from the scene to that of --to.
    turn : value, optional
        Degrees that the camera turns, clockwise seen from above; negative: the other way around.
    along : value, optional
        Direction in which the section moves: across inlines, across crosslines, or down.
    to : value, optional
        Scene that the motion leads to, a name or a TOML file; it means --motion scenes.
    frames : value, optional
        Number of frames, 2 to 2000.
    rate : value, optional
        Frames a second, 0.1 to 50.
    once : bool
        End at the end: otherwise all but whole turns go back to the beginning in the second half of the frames.
    device : value, optional
        Device that draws: the graphics adapter, or the processor when there is none (auto), or one of the two.
    volume_memory : value, optional
        Largest memory for the samples of one volume, such as 2G; a larger volume is shown at a coarser level of its
        pyramid [default: half of what is free].
    size : value, optional
        Size of the image in pixels.
    blend : value, optional
        Blend from 0 = illustrative to 1 = raw data.
    lookup : value, optional
        How layer coordinates are looked up: exact, or the packed volume of the published method.
    exaggeration : value, optional
        Vertical exaggeration.
    azimuth : value, optional
        Bearing in which the camera looks, degrees clockwise from north.
    elevation : value, optional
        Height of the camera above the horizontal, degrees.
    perspective : value, optional
        Use a perspective with this opening angle instead of a parallel projection.
    zoom : value, optional
        Magnification, as a factor on the scale at which the block fits the image.
    box : value, optional
        Show only this part of the survey: inlines, crosslines, vertical values.
    cut : value or values, optional
        Cut a corner off over the whole height: nearest, min-min, min-max, max-min or max-max (first and last inline,
        crossline), and the share of the block's length along inlines and crosslines; repeat it for several.
    cut_box : value or values, optional
        Cut a box out; repeat it for several.
    cut_fence : value or values, optional
        Cut everything away that lies before a wall on a line with these corners, two or more: line numbers, or
        well:NAME for the head of a well. The line's ends go on straight.
    cut_side : value, optional
        The side of --cut-fence that is cut away, seen along the line on a map with inlines' indices to the right and
        crosslines' upwards [default: the viewer's].
    cut_smooth : bool
        Lead a curve through the corners of --cut-fence.
    cut_round : value or values, optional
        Cut a round shaft: inline, crossline, radius in metres; repeat it for several.
    cut_depth : value, optional
        Limit --cut-fence and --cut-round to these vertical values.
    cut_plane : value or values, optional
        Cut everything away above a plane through a place: inline, crossline, vertical value, bearing of its dip and
        dip in degrees; repeat it for several.
    ground : value, optional
        Show the relief of the topmost horizon instead of a flat top.
    ground_opacity : value, optional
        Opacity of that relief.
    water : value, optional
        Fill what lies above that relief with water, up to this depth or time, to which the block reaches at least;
        ground above it stays dry; `off`: air.
    show : value, optional
        What faces show: the rock, the leaves of horizon candidates in colours, the distance to the nearest candidate,
        or how much patterns are distorted (white: not; blue: too dense or narrow; orange: too sparse or wide), with
        the shares of area printed. In volume rendering, leaves colour the horizons shown, or all candidates.
    level : value, optional
        Colour leaves by the node this many levels up their surface tree; 0 = the leaf itself. Shows leaves unless
        --show says otherwise.
    outlines : value, optional
        Draw lines along horizons, faults and edges; dashed: dashed on the block where a horizon was not picked, but
        filled or extrapolated (sections and fences always are).
    global_frequency : value, optional
        Factor on the frequency of every pattern.
    pattern_size : value, optional
        What patterns are fixed to in a close-up: to the rock, so that they grow with it, or to the paper, so that
        they keep the size that they have where the whole survey fits the picture.
    preset : value, optional
        Colours, black patterns on white, or shades of grey. What is measured stays in shades of grey where there are
        no colours.
    samples : value, optional
        Samples per pixel along each axis.
    background : value, optional
        Colour behind the block, or `transparent`.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "animate",
        project,
        out,
        scene=scene,
        motion=motion,
        turn=turn,
        along=along,
        to=to,
        frames=frames,
        rate=rate,
        once=once,
        device=device,
        volume_memory=volume_memory,
        size=size,
        blend=blend,
        lookup=lookup,
        exaggeration=exaggeration,
        azimuth=azimuth,
        elevation=elevation,
        perspective=perspective,
        zoom=zoom,
        box=box,
        cut=cut,
        cut_box=cut_box,
        cut_fence=cut_fence,
        cut_side=cut_side,
        cut_smooth=cut_smooth,
        cut_round=cut_round,
        cut_depth=cut_depth,
        cut_plane=cut_plane,
        ground=ground,
        ground_opacity=ground_opacity,
        water=water,
        show=show,
        level=level,
        outlines=outlines,
        global_frequency=global_frequency,
        pattern_size=pattern_size,
        preset=preset,
        samples=samples,
        background=background,
        progress=progress,
    )


def review(
    project: Value,
    out: Value,
    *,
    scene: Values | None = None,
    density: Value | None = None,
    sections: Value | None = None,
    size_limit: Value | None = None,
    device: Value | None = None,
    volume_memory: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Write a page for any browser: the block in 3D, to turn, cut, blend and read, without a network.

    Parameters
    ----------
    project : value
        Project folder.
    out : value
        Page to write, such as north.html.
    scene : value or values, optional
        Scene to show; repeat it for several [default: all scenes of the project, or the default view].
    density : value, optional
        Texels along the longest side of the block.
    sections : value, optional
        Inlines, crosslines and slices to step through, of each so many; 0 for none.
    size_limit : value, optional
        Largest size of the page in MB; pictures of faces get coarser until it fits.
    device : value, optional
        Device that draws: the graphics adapter, or the processor when there is none (auto), or one of the two.
    volume_memory : value, optional
        Largest memory for the samples of one volume, such as 2G; a larger volume is shown at a coarser level of its
        pyramid [default: half of what is free].
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "review",
        project,
        out,
        scene=scene,
        density=density,
        sections=sections,
        size_limit=size_limit,
        device=device,
        volume_memory=volume_memory,
        progress=progress,
    )


def note_list(
    project: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """List the notes with their numbers.

    Parameters
    ----------
    project : value
        Project folder.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "note",
        "list",
        project,
        progress=progress,
    )


def note_add(
    project: Value,
    text: Value,
    *,
    at: Value | None = None,
    scene: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Write a note on a place.

    Parameters
    ----------
    project : value
        Project folder.
    text : value
        Text of the note.
    at : value, optional
        The place: inline, crossline, vertical value.
    scene : value, optional
        Show it in this scene alone.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "note",
        "add",
        project,
        text,
        at=at,
        scene=scene,
        progress=progress,
    )


def note_remove(
    project: Value,
    number: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Remove a note.

    Parameters
    ----------
    project : value
        Project folder.
    number : value
        Number of the note, as `note list` shows it.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "note",
        "remove",
        project,
        number,
        progress=progress,
    )


def view(
    project: Value | None = None,
    *,
    frame_times: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Open the window, for the whole work from volume to picture.

    Parameters
    ----------
    project : value, optional
        Project folder; without one the start page opens.
    frame_times : value, optional
        Record how long each frame takes, as CSV; frames then follow one another without pause.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "view",
        *([] if project is None else [project]),
        frame_times=frame_times,
        progress=progress,
    )


def patterns(
    out: Value,
    *,
    project: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Draw a sheet of every pattern with its name.

    Parameters
    ----------
    out : value
        PNG file to write.
    project : value, optional
        Project whose own tiles are shown too.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "patterns",
        out,
        project=project,
        progress=progress,
    )


def bench(
    *,
    quick: bool = False,
    dump: Value | None = None,
    segy: Value | None = None,
    progress: Progress | None = None,
) -> Answer:
    """Measure how long the stages take on this machine.

    Parameters
    ----------
    quick : bool
        Use small sizes, which take seconds instead of minutes.
    dump : value, optional
        Write the model that is measured here as NumPy files, to time other programs on.
    segy : value, optional
        Measure instead how fast a SEG-Y cube is read and stored, with files in this folder, which stay there for
        other programs.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "bench",
        quick=quick,
        dump=dump,
        segy=segy,
        progress=progress,
    )


def undo(
    project: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Undo the last command.

    Parameters
    ----------
    project : value
        Project folder.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "undo",
        project,
        progress=progress,
    )


def redo(
    project: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Redo the command that was undone last.

    Parameters
    ----------
    project : value
        Project folder.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "redo",
        project,
        progress=progress,
    )


def check(
    project: Value,
    *,
    repair: bool = False,
    progress: Progress | None = None,
) -> Answer:
    """Check that everything in a project is there and undamaged; the exit code is 1 if something is damaged.

    Parameters
    ----------
    project : value
        Project folder.
    repair : bool
        Remove leftovers and damaged derived data, set damaged history aside, restore a damaged project.toml; data
        that a state needs are never deleted.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "check",
        project,
        repair=repair,
        progress=progress,
    )


def prune(
    project: Value,
    *,
    progress: Progress | None = None,
) -> Answer:
    """Delete the history and the data that only the history refers to.

    Parameters
    ----------
    project : value
        Project folder.
    progress : callable, optional
        Called as ``progress(stage, done, total)``.
    """
    return run(
        "prune",
        project,
        progress=progress,
    )
