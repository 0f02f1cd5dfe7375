"""Every change of a project as a method with named, typed arguments.

Each method makes the object that :meth:`Commands.apply` takes; nothing else changes a project.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, Literal

from petroglyph._types import Options, Path, Progress

Effect = dict[str, Any]
Place = tuple[float, float, float]
Noun = Literal["volume", "horizon", "fault", "well", "layer", "texture", "parameterization", "scene", "note", "figure"]
Contact = Literal["conformable", "erosional", "onlap", "intrusive"]


def _given(**fields: Any) -> dict[str, Any]:
    """The fields that were given."""
    return {name: value for name, value in fields.items() if value is not None}


class Commands:
    """The commands. Each returns what it did, as `--json` of the command line says it."""

    def apply(
        self, command: Mapping[str, Any], *, memory: int | None = None, progress: Progress | None = None
    ) -> Effect:
        """Carries out any command; see :meth:`Project.apply`."""
        raise NotImplementedError

    # Volumes.

    def import_(
        self,
        path: Path,
        *,
        name: str | None = None,
        polarity: Literal["normal", "reverse"] = "normal",
        options: Options | None = None,
        origin: Options | None = None,
        memory: int | None = None,
        progress: Progress | None = None,
    ) -> Effect:
        """Reads a SEG-Y file, or the folder of a stored volume, into the project.

        Parameters
        ----------
        path : path
            File or folder.
        name : str, optional
            Name of the volume; by default "seismic" for the first, and the file's name for others.
        polarity : {"normal", "reverse"}
            What a positive amplitude means.
        options : mapping, optional
            What is stated about the file: ``inline_byte``, ``crossline_byte``, ``x_byte``, ``y_byte`` and so on.
        origin : mapping, optional
            Where a stored volume came from, such as ``{"kind": "array"}``; by default from its folder.
        memory : int, optional
            Memory to use, bytes; by default half of what is available.
        progress : callable, optional
            Called as ``progress(stage, done, total)``.
        """
        fields = _given(path=os.fspath(path), name=name, polarity=polarity, options=options, origin=origin)
        return self.apply({"import": fields}, memory=memory, progress=progress)

    def attribute(
        self,
        kind: Literal["semblance", "envelope", "dip", "fault-likelihood", "throw", "flattened", "hiatus"],
        name: str,
        *,
        volume: str | None = None,
        dip: Options | None = None,
        semblance: Options | None = None,
        memory: int | None = None,
        progress: Progress | None = None,
    ) -> Effect:
        """Computes a volume from a volume.

        Parameters
        ----------
        kind : {"semblance", "envelope", "dip", "fault-likelihood", "throw", "flattened", "hiatus"}
            What to compute.
        name : str
            Name of the new volume; a dip adds ``NAME-inline`` and ``NAME-crossline``.
        volume : str, optional
            The volume it is computed from; by default the first.
        dip, semblance : mapping, optional
            Settings: ``max_dip``, ``half_window``, ``half_width``.
        memory : int, optional
            Memory to use, bytes.
        progress : callable, optional
            Called as ``progress(stage, done, total)``.
        """
        fields = _given(kind=kind, name=name, volume=volume, dip=dip, semblance=semblance)
        return self.apply({"attribute": fields}, memory=memory, progress=progress)

    def extract(
        self,
        *,
        volume: str | None = None,
        settings: Options | None = None,
        memory: int | None = None,
        progress: Progress | None = None,
    ) -> Effect:
        """Finds horizon candidates: surfaces, their trees, and the closest leaf of every voxel.

        What takes more than `memory` (bytes; by default half of what is available) is done in bricks, with the same result.
        """
        return self.apply({"extract": _given(volume=volume, settings=settings)}, memory=memory, progress=progress)

    def time(
        self,
        name: str = "time",
        *,
        settings: Options | None = None,
        memory: int | None = None,
        progress: Progress | None = None,
    ) -> Effect:
        """Computes geologic time, a volume in which every bed has one value.

        A survey that needs more than `memory` (bytes; by default half of what is available) is solved in slabs.
        """
        return self.apply({"time": _given(name=name, settings=settings, memory_bytes=memory)}, progress=progress)

    def propose_faults(self, *, settings: Options | None = None, progress: Progress | None = None) -> Effect:
        """Proposes faults from the offsets of horizons, or from where candidates end."""
        return self.apply({"propose-faults": _given(settings=settings)}, progress=progress)

    def link_volume(
        self,
        url: str,
        *,
        name: str | None = None,
        polarity: Literal["normal", "reverse"] = "normal",
        progress: Progress | None = None,
    ) -> Effect:
        """Takes in a volume that stays in object storage, where the package was built with it."""
        fields = _given(url=url, name=name, polarity=polarity)
        return self.apply({"link-volume": fields}, progress=progress)

    def rename(self, noun: Noun, from_: str, to: str) -> Effect:
        """Gives something another name; what refers to it follows, and nothing is computed anew."""
        return self.apply({"rename": {"noun": noun, "from": from_, "to": to}})

    def remove(self, noun: Noun, name: str) -> Effect:
        """Removes something, and with it what refers to it: a map of a horizon goes with the horizon."""
        return self.apply({"remove": {"noun": noun, "name": name}})

    def set_colour(self, noun: Literal["horizon", "fault", "well", "layer"], name: str, colour: str) -> Effect:
        """Gives something another colour."""
        return self.apply({"set-colour": {"noun": noun, "name": name, "colour": colour}})

    def rename_volume(self, from_: str, to: str) -> Effect:
        """Gives a volume another name, also where it is shown."""
        return self.apply({"rename": {"noun": "volume", "from": from_, "to": to}})

    def remove_volume(self, name: str) -> Effect:
        """Removes a volume."""
        return self.apply({"remove": {"noun": "volume", "name": name}})

    # Horizons.

    def add_horizon(
        self,
        path: Path,
        name: str,
        *,
        contact: Contact | None = None,
        age: str | Mapping[str, str] | None = None,
        options: Options | None = None,
        progress: Progress | None = None,
    ) -> Effect:
        """Reads a horizon from a file.

        Parameters
        ----------
        path : path
            File in any format that the program reads.
        name : str
            Name of the horizon.
        contact : {"conformable", "erosional", "onlap", "intrusive"}, optional
            Its contact with its neighbours.
        age : str or mapping, optional
            Where it goes: ``"by-depth"``, ``{"above": NAME}`` or ``{"below": NAME}``.
        options : mapping, optional
            What is stated about the file: ``format``, ``z_unit``, ``null`` and so on.
        progress : callable, optional
            Called as ``progress(stage, done, total)``.
        """
        fields = _given(path=os.fspath(path), name=name, contact=contact, age=age, options=options)
        return self.apply({"add-horizon": fields}, progress=progress)

    def rename_horizon(self, from_: str, to: str) -> Effect:
        """Gives a horizon another name."""
        return self.apply({"rename": {"noun": "horizon", "from": from_, "to": to}})

    def remove_horizon(self, name: str) -> Effect:
        """Removes a horizon."""
        return self.apply({"remove": {"noun": "horizon", "name": name}})

    def pick(
        self,
        at: Place,
        horizon: str,
        *,
        operation: Literal["add", "remove"] | None = None,
        colour: str | None = None,
        climb: int | Literal["highest-valid"] = 0,
        progress: Progress | None = None,
    ) -> Effect:
        """Adds the candidate at a place to a horizon, or takes it out.

        Parameters
        ----------
        at : tuple
            Inline, crossline and vertical value.
        horizon : str
            The horizon; it is made if it does not exist.
        operation : {"add", "remove"}, optional
            Whether the candidate is added (the default) or taken out.
        colour : str, optional
            Colour of the horizon, ``"#RRGGBB"``.
        climb : int or "highest-valid"
            Levels to climb above the leaf, or to the highest node without two depths at one trace.
        progress : callable, optional
            Called as ``progress(stage, done, total)``.
        """
        fields = self._node(at, horizon, operation, colour, climb)
        return self.apply({"pick": fields}, progress=progress)

    @staticmethod
    def _node(
        at: Place, horizon: str, operation: str | None, colour: str | None, climb: int | str
    ) -> dict[str, Any]:
        levels: Any = {"levels": climb} if isinstance(climb, int) else climb
        return _given(at=list(at), horizon=horizon, operation=operation, colour=colour, climb=levels)

    def pick_by_time(
        self,
        horizon: str,
        *,
        through: Place | None = None,
        of: float | None = None,
        progress: Progress | None = None,
    ) -> Effect:
        """Adds the level of geologic time through a place, or of a value, as a horizon."""
        level: dict[str, Any] = {"through": list(through)} if through is not None else {"of": of}
        return self.apply({"pick-by-time": {"level": level, "horizon": horizon}}, progress=progress)

    def pick_several(
        self,
        horizon: str,
        places: Sequence[Place],
        *,
        climb: int | Literal["highest-valid"] = "highest-valid",
        progress: Progress | None = None,
    ) -> Effect:
        """Adds the candidates at several places to one horizon, in one step of the history."""
        picks = [self._node(at, horizon, None, None, climb) for at in places]
        return self.apply({"pick-several": {"picks": picks}}, progress=progress)

    def draw_horizon(
        self, horizon: str, part: Options, *, colour: str | None = None, progress: Progress | None = None
    ) -> Effect:
        """Draws a line of a horizon, or tracks it from a place."""
        return self.apply({"draw-horizon": _given(horizon=horizon, colour=colour, part=part)}, progress=progress)

    def move_pick(
        self, id: int, to: Literal["highest-valid"] | Mapping[str, int], *, progress: Progress | None = None
    ) -> Effect:
        """Moves a pick in its tree: ``{"up": N}``, ``{"down": N}`` or ``"highest-valid"``."""
        return self.apply({"move-pick": {"id": id, "to": to}}, progress=progress)

    def climb(self, id: int, levels: int = 1) -> Effect:
        """Moves a pick up its tree."""
        return self.move_pick(id, {"up": levels})

    def descend(self, id: int, levels: int = 1) -> Effect:
        """Moves a pick down its tree."""
        return self.move_pick(id, {"down": levels})

    def remove_pick(self, id: int) -> Effect:
        """Takes a pick out of its horizon's log."""
        return self.apply({"remove-pick": {"id": id}})

    def set_horizon_colour(self, horizon: str, colour: str) -> Effect:
        """Gives a horizon another colour."""
        return self.apply({"set-colour": {"noun": "horizon", "name": horizon, "colour": colour}})

    def replay_picks(
        self,
        *,
        horizon: str | None = None,
        unfit: Literal["refuse", "drop"] | None = None,
        progress: Progress | None = None,
    ) -> Effect:
        """Makes picks again on the present extraction."""
        return self.apply({"replay-picks": _given(horizon=horizon, unfit=unfit)}, progress=progress)

    def fill_horizon(self, name: str, *, settings: Options | None = None, progress: Progress | None = None) -> Effect:
        """Fills the holes of a horizon, never across a fault."""
        return self.apply({"fill-horizon": _given(name=name, settings=settings)}, progress=progress)

    def smooth_horizon(self, name: str, *, settings: Options | None = None, progress: Progress | None = None) -> Effect:
        """Smooths a horizon, never across a fault."""
        return self.apply({"smooth-horizon": _given(name=name, settings=settings)}, progress=progress)

    def stack_horizons(
        self,
        name: str,
        count: int,
        *,
        between: tuple[str, str] | None = None,
        spacing: Literal["isochrons", "proportional"] = "isochrons",
        progress: Progress | None = None,
    ) -> Effect:
        """Adds a stack of horizons, `name` with a number each: isochrons, or surfaces at equal shares of the thickness
        between two horizons (the upper and the lower one)."""
        fields = _given(count=count, between=None if between is None else list(between), spacing=spacing, name=name)
        return self.apply({"stack-horizons": fields}, progress=progress)

    def outline_bodies(self, name: str, *, most: int = 3, progress: Progress | None = None) -> Effect:
        """Adds the outlines of isolated bodies (a flat spot, a build-up) as closed horizons, `name` with a number each."""
        return self.apply({"outline-bodies": {"name": name, "most": most}}, progress=progress)

    def set_contact(self, horizon: str, contact: Contact) -> Effect:
        """States the contact of a horizon with its neighbours."""
        return self.apply({"set-contact": {"horizon": horizon, "contact": contact}})

    # Faults.

    def add_fault(
        self,
        path: Path,
        name: str,
        *,
        truncated_by: str | None = None,
        grown_m: float | None = None,
        options: Options | None = None,
        progress: Progress | None = None,
    ) -> Effect:
        """Reads a fault from a file.

        Parameters
        ----------
        path : path
            File in any format that the program reads.
        name : str
            Name of the fault.
        truncated_by : str, optional
            The fault that it ends at.
        grown_m : float, optional
            By how much it reaches beyond what was drawn, m.
        options : mapping, optional
            What is stated about the file.
        progress : callable, optional
            Called as ``progress(stage, done, total)``.
        """
        fields = _given(
            path=os.fspath(path), name=name, truncated_by=truncated_by, grown_m=grown_m, options=options
        )
        return self.apply({"add-fault": fields}, progress=progress)

    def pick_fault(self, name: str, sticks: Sequence[Sequence[Place]], *, progress: Progress | None = None) -> Effect:
        """Draws a fault by sticks, each of at least two places: inline, crossline, vertical value."""
        drawn = [[list(place) for place in stick] for stick in sticks]
        return self.apply({"pick-fault": {"name": name, "sticks": drawn}}, progress=progress)

    def move_stick_point(self, fault: str, stick: int, point: int, to: Place) -> Effect:
        """Moves a point of a stick; both are counted from 0."""
        fields = {"fault": fault, "stick": stick, "point": point, "to": list(to)}
        return self.apply({"move-stick-point": fields})

    def accept_fault(self, id: int, name: str) -> Effect:
        """Takes a proposed fault into the project."""
        return self.apply({"accept-fault": {"id": id, "name": name}})

    def cut_fault(
        self, fault: str, at: Place, *, along: Literal["dip", "strike"] = "dip", name: str | None = None
    ) -> Effect:
        """Cuts a fault in two: from top to bottom through a place, or along its strike at its level.

        Parameters
        ----------
        fault : str
            Name of the fault; the larger part keeps it.
        at : Place
            Inline, crossline, vertical value.
        along : {"dip", "strike"}
            Which way the cut runs.
        name : str, optional
            Name of the smaller part; by default that of the fault with a number.
        """
        return self.apply({"cut-fault": _given(fault=fault, at=list(at), along=along, name=name)})

    def merge_faults(self, faults: Sequence[str], name: str) -> Effect:
        """Makes one fault of several that continue one another; `name` is that of one of them, or a new one."""
        return self.apply({"merge-faults": {"faults": list(faults), "name": name}})

    def give_sticks(self, fault: str) -> Effect:
        """Gives a proposed or imported fault sticks, whose points can be moved."""
        return self.apply({"give-sticks": {"fault": fault}})

    def set_truncation(self, fault: str, by: str | None = None) -> Effect:
        """States at which other fault a fault ends; without one, at none."""
        return self.apply({"set-truncation": _given(fault=fault, by=by)})

    def set_fault_extent(self, fault: str, grown_m: float = 0.0) -> Effect:
        """States how far a fault reaches beyond what was drawn, m."""
        return self.apply({"set-fault-extent": {"fault": fault, "grown_m": grown_m}})

    def set_fault_colour(self, fault: str, colour: str) -> Effect:
        """Gives a fault another colour, on sections and on the block."""
        return self.apply({"set-colour": {"noun": "fault", "name": fault, "colour": colour}})

    def rename_fault(self, from_: str, to: str) -> Effect:
        """Gives a fault another name."""
        return self.apply({"rename": {"noun": "fault", "from": from_, "to": to}})

    def remove_fault(self, name: str) -> Effect:
        """Removes a fault."""
        return self.apply({"remove": {"noun": "fault", "name": name}})

    # Wells.

    def add_well(
        self, name: str, files: Options, *, options: Options | None = None, progress: Progress | None = None
    ) -> Effect:
        """Reads a well: `files` has ``deviation`` and, if there are such, ``tops``, ``las`` and ``checkshot``."""
        return self.apply({"add-well": _given(name=name, files=files, options=options)}, progress=progress)

    def rename_well(self, from_: str, to: str) -> Effect:
        """Gives a well another name."""
        return self.apply({"rename": {"noun": "well", "from": from_, "to": to}})

    def set_well_colour(self, well: str, colour: str) -> Effect:
        """Gives a well another colour, in the block and on sections."""
        return self.apply({"set-colour": {"noun": "well", "name": well, "colour": colour}})

    def remove_well(self, name: str) -> Effect:
        """Removes a well."""
        return self.apply({"remove": {"noun": "well", "name": name}})

    # Looks.

    def set_velocity(self, velocity_m_s: float) -> Effect:
        """States the velocity that turns two-way time into metres."""
        return self.apply({"set-velocity": {"velocity_m_s": velocity_m_s}})

    def set_layer(
        self,
        layer: str,
        *,
        name: str | None = None,
        colour: str | None = None,
        ink: str | None = None,
        pattern: str | None = None,
        rock: str | None = None,
        age: str | None = None,
        intervals: Sequence[Options] | None = None,
        frequency: Options | None = None,
        opacity: float | None = None,
        k: str | None = None,
        style: Options | None = None,
    ) -> Effect:
        """Changes how a layer looks.

        Parameters
        ----------
        layer : str
            The layer's present name.
        name : str, optional
            A new name.
        colour, ink : str, optional
            Colours under the pattern and of its lines, ``"#RRGGBB"``.
        pattern : str, optional
            One pattern from bottom to top.
        rock, age : str, optional
            A rock or a unit of geological time, whose look the layer takes.
        intervals : sequence of mapping, optional
            Patterns by depth in the layer: ``{"k": [0, 0.5], "texture": NAME}``.
        frequency : mapping, optional
            ``horizontal`` and ``vertical``: repeats of the tile.
        opacity : float, optional
            Opacity inside a cut-out, 0 to 1.
        k : str, optional
            What k means in the layer: ``"flow"``, ``"harmonic"``, ``"proportional"`` and so on.
        style : mapping, optional
            The whole style, applied before the other changes.
        """
        fields = _given(
            layer=layer, name=name, colour=colour, ink=ink, pattern=pattern, rock=rock, age=age,
            intervals=intervals, frequency=frequency, opacity=opacity, k=k, style=style,
        )  # fmt: skip
        return self.apply({"set-layer": fields})

    def reset_layer(self, layer: str) -> Effect:
        """Removes a layer's style."""
        return self.apply({"reset-layer": {"layer": layer}})

    def set_scalar(self, function: Options) -> Effect:
        """Lays textures over the layers by the values of a volume: ``{"volume": …, "intervals": […]}``."""
        return self.apply({"set-scalar": {"function": function}})

    def remove_scalar(self, volume: str) -> Effect:
        """Removes the textures of a volume."""
        return self.apply({"remove-scalar": {"volume": volume}})

    def set_raw(self, raw: Options) -> Effect:
        """Sets which volume is shown as raw data, and its colours."""
        return self.apply({"set-raw": {"raw": raw}})

    def add_texture(self, path: Path, *, width_mm: float | None = None) -> Effect:
        """Adds a tile of one's own: PNG, JPEG or SVG."""
        return self.apply({"add-texture": _given(path=os.fspath(path), width_mm=width_mm)})

    def set_parameterization(
        self, from_: Path | None = None, *, by_time: bool = False, progress: Progress | None = None
    ) -> Effect:
        """Takes i, j, k from a Zarr group of another program; without one they are computed here, `by_time` with k as the
        fraction of geologic time between the two horizons of a layer."""
        fields: dict[str, Any] = {} if from_ is None else {"from": os.fspath(from_)}
        if by_time:
            fields["by_time"] = True
        return self.apply({"set-parameterization": fields}, progress=progress)

    # Scenes and notes.

    def add_scene(self, name: str, scene: Options) -> Effect:
        """Saves a scene under a name."""
        return self.apply({"add-scene": {"name": name, "scene": scene}})

    def rename_scene(self, from_: str, to: str) -> Effect:
        """Gives a scene another name, also in notes and figures."""
        return self.apply({"rename": {"noun": "scene", "from": from_, "to": to}})

    def remove_scene(self, name: str) -> Effect:
        """Removes a scene."""
        return self.apply({"remove": {"noun": "scene", "name": name}})

    def tell_history(
        self, text: str, *, until: float | None = None, progress: Progress | None = None
    ) -> Effect:
        """Makes the block that a geological history tells of, in a project that has none.

        Parameters
        ----------
        text : str
            The events as TOML, oldest first (``docs/history.md``).
        until : float, optional
            How many of its events have happened: 2.5 is after two of them and half of the third. Default: all.
        progress : callable, optional
            Called as ``progress(stage, done, total)``.
        """
        return self.apply({"tell-history": _given(text=text, until=until)}, progress=progress)

    def restore(
        self,
        source: Path,
        to: str,
        *,
        regional: bool = False,
        dip: tuple[float, float] | None = None,
        depth: float | None = None,
        progress: Progress | None = None,
    ) -> Effect:
        """Makes the interpretation of another project as it was when one of its horizons was laid down, in a project that has none.

        Parameters
        ----------
        source : path
            The folder of the other project, which is not changed.
        to : str
            The horizon that is laid flat; what is younger is taken away.
        regional : bool
            Lay it on the plane that fits it best instead of level.
        dip : (float, float), optional
            Lay it on a plane with this dip and direction, both in degrees.
        depth : float, optional
            Its depth in the middle of the survey. Default: the mean of its nodes stays where it is.
        progress : callable, optional
            Called as ``progress(stage, done, total)``.
        """
        if regional and dip is not None:
            raise ValueError("state regional or dip, not both")
        datum: Any = "regional" if regional else "flat"
        if dip is not None:
            datum = {"dipping": {"dip": dip[0], "direction": dip[1]}}
        settings = _given(datum=datum, depth=depth)
        command = {"source": os.fspath(source), "to": to, "settings": settings}
        return self.apply({"restore": command}, progress=progress)

    def add_note(self, text: str, at: Place, *, scene: str | None = None) -> Effect:
        """Writes a note on a place."""
        return self.apply({"add-note": {"note": _given(text=text, at=list(at), scene=scene)}})

    def remove_note(self, number: int) -> Effect:
        """Removes a note, counted from 1."""
        return self.apply({"remove": {"noun": "note", "name": str(number)}})
