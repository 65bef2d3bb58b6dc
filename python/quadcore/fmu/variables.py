"""Variables of an FMU; the index in the list is the value reference."""

from __future__ import annotations

from typing import Dict, Iterator, List, NamedTuple, Optional, Sequence

from .. import _core
from .._core import InputError
from ..simulation.simulation import Simulation

_WRENCH = (("fx", "N"), ("fy", "N"), ("fz", "N"), ("tx", "N.m"), ("ty", "N.m"), ("tz", "N.m"))
_SPAWN = ("x", "y", "z", "roll", "pitch", "yaw")
_STATE_UNITS = ("s", "m", "m", "m", "", "", "", "", *["m/s"] * 3, *["rad/s"] * 3)
_LARGEST_SEED = 2**31 - 1  # maximum value of an Integer


class Variable(NamedTuple):
    """Variable of an FMU."""

    name: str
    kind: str
    """Kind, as in cpp/fmu/flight_file.hpp."""
    key: str
    """Name of the topic, or PLUGIN.TAG."""
    place: int
    """Index in the row, or among the fields of the topic."""
    type: str
    """Real, Integer, Boolean or String."""
    causality: str
    variability: str
    start: Optional[str] = None
    unit: str = ""
    description: str = ""


def list_variables(simulation: Simulation) -> List[Variable]:
    """List all variables of a simulation.

    Raises
    ------
    InputError
        If two variables have the same name.
    """
    of_topics = [*_list_outputs(simulation), *_list_inputs(simulation)]
    taken = {variable.name for variable in of_topics}
    parameters = [  # a topic with its field can have the same name as a plugin with its tag
        tag._replace(name=f"{tag.name}_tag") if tag.name in taken else tag
        for tag in _list_parameters(simulation)
    ]
    found = [*of_topics, *parameters]
    known: Dict[str, Variable] = {}
    for variable in found:
        other = known.setdefault(variable.name, variable)
        if other is not variable:
            raise InputError(
                f"an FMU would have two variables {variable.name}, of kind {other.kind} "
                f"and {variable.kind}. Rename the plugin or the topic."
            )
    return found


def _list_outputs(simulation: Simulation) -> Iterator[Variable]:
    columns = _core.log_columns(simulation.rotor_count)
    units = [*_STATE_UNITS, *["rad/s"] * simulation.rotor_count]
    for i, (name, unit) in enumerate(zip(columns, units)):
        if i > 0:  # the importer defines the time
            yield _make_output(name, "state", "", i, unit, "continuous")
    for number, term in enumerate(simulation.wrench_terms):
        for i, (component, unit) in enumerate(_WRENCH):
            name = f"wrench_{term}.{component}"
            yield _make_output(name, "wrench", term, 6 * number + i, unit, "continuous")
    for topic in simulation.topics.values():
        if topic.writer is not None:
            for i, field in enumerate(["stamp", *topic.fields]):
                yield _make_output(f"{topic.name}.{field}", "topic", topic.name, i, "", "discrete")


def _make_output(
    name: str, kind: str, key: str, index: int, unit: str, variability: str
) -> Variable:
    return Variable(name, kind, key, index, "Real", "output", variability, unit=unit)


def _list_inputs(simulation: Simulation) -> Iterator[Variable]:
    for topic in simulation.topics.values():
        if topic.writer is None:
            is_command = topic.name == simulation.command_topic
            start = simulation.topic(topic.name)  # contains the initial values
            for i, field in enumerate(topic.fields):
                name = field if is_command else f"{topic.name}.{field}"
                yield Variable(
                    name, "input", topic.name, i, "Real", "input", "discrete",
                    repr(start[field]),
                    "rad/s" if is_command else "",
                )  # fmt: skip


def _list_parameters(simulation: Simulation) -> Iterator[Variable]:
    for plugin in simulation.plugins:
        for tag in plugin.parameters:
            key = f"{plugin.name}.{tag.name}"
            is_number = tag.kind == "number" and tag.text != ""
            kind = "file" if tag.kind == "file" else "parameter"
            types = {"flag": "Boolean", "number": "Real"}  # missing values are empty texts
            yield Variable(
                key, kind, key, 0, types.get(tag.kind if tag.text else "", "String"), "parameter",
                "tunable" if is_number else "fixed", tag.text, tag.unit if is_number else "",
                tag.meaning,
            )  # fmt: skip


def list_start_variables(spawn: Sequence[float], seed: int) -> Iterator[Variable]:
    """Yield the parameters for the initial pose and the seed."""
    for i, (name, value) in enumerate(zip(_SPAWN, spawn)):
        yield Variable(
            f"spawn.{name}", "spawn", "", i, "Real", "parameter", "fixed", repr(value),
            "m" if i < 3 else "rad", "where the flight begins",
        )  # fmt: skip
    if seed <= _LARGEST_SEED:
        yield Variable(
            "seed", "seed", "", 0, "Integer", "parameter", "fixed", str(seed),
            description="of all random numbers",
        )  # fmt: skip
