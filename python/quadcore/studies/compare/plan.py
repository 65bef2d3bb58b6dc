"""The flights of a comparison: everything read and checked before the first takes off."""

from __future__ import annotations

import difflib
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

from ..._core import InputError, QuadcoreError, World, check_ignored, engines
from ...model.description import list_of_names, read_model, read_world
from ...model.overrides import XACRO, check_names, link_values, without_xacro
from ...simulation.commands import CommandsLike, as_commands
from ...simulation.controller_pilot import faults_told
from ...simulation.flight import check_logged
from ...simulation.flight_plan import FlightPlan
from ...simulation.log import Log
from ...simulation.scenarios import read as read_scenario
from ...simulation.simulation import Simulation
from ...support.files import shown
from ...support.values import SPAWN, text_of
from ..axes import WHOLE, Axis, Values, axes_of, check_size, variants
from ..guidance import Guidance
from .difference import Difference, differences, facts

Variant = Tuple[int, Tuple[str, ...]]

_READ = 16  # models that are kept as they were read


class Plan:
    """Variants of one flight.

    Parameters
    ----------
    models
        Files or names of shipped models.
    vary
        Values by axis.
    commands
        Flown by each.
    duration, log_every
        As for `Simulation.run`.
    options
        As for `Simulation`, and `scenario`, which all fly in. Flights that are guided begin on the
        reference, if one is given, and no spawn.
    guided
        Arguments of `Guidance`: controller, reference, controller_rate, delay.

    Raises
    ------
    InputError
        Too many variants, a model, world or commands file that cannot be read, an unknown tag or
        engine, or models that cannot share the commands.
    """

    def __init__(
        self,
        models: Sequence[Union[str, Path]],
        vary: Mapping[str, Values],
        commands: Optional[CommandsLike],
        duration: float,
        log_every: int,
        options: Mapping[str, Any],
        guided: Mapping[str, Any],
    ) -> None:
        self.axes = axes_of(vary)
        self.count = check_size(len(models), self.axes)
        self.names = [shown(model) for model in models]
        own = dict(options)
        ignore = own.pop("ignore", ())
        arguments, given = without_xacro(own.pop("parameters", None), own.pop("xacro_args", None))
        self._set = {key: text_of(value) for key, value in given.items()}
        self._taken = [*self._set, *(f"{XACRO}.{name}" for name in arguments)]
        self._read = lru_cache(_READ)(
            lambda i, varied: read_model(models[i], {**arguments, **dict(varied)}, ignore)
        )
        self._models = [self._read(i, ()) for i in range(len(models))]
        self._worlds = {name: read_world(name, ignore) for name in self._values("world")}
        given_scenario = own.pop("scenario", None)
        if given_scenario is not None and self._values("scenario"):
            raise InputError("vary scenario: it is given as well; keep one")
        self._scenario = read_scenario(given_scenario)
        self._scenarios = {name: read_scenario(name) for name in self._values("scenario")}
        world = own.pop("world", None)
        if not isinstance(world, World):
            world = read_world(world, ignore)
        readings = [model.passed_over for model in self._models]
        readings += [each.passed_over for each in (*self._worlds.values(), world)]
        check_ignored(list_of_names("ignore", ignore), readings)
        self._check_engines()
        spawn = own.pop("spawn", None)
        vehicles = [model.name for model in self._models]
        self.guidance = Guidance(spawn=spawn, vehicles=vehicles, **guided)
        if commands is not None and self.guidance.is_given:
            raise InputError("a flight takes commands or a controller; give one of them")
        self._base = FlightPlan.of(
            self._models[0],
            world,
            parameters=self._set,
            spawn=SPAWN if spawn is None else spawn,
            duration=duration,
            log_every=log_every,
            **own,
        )
        built = self._built()
        self.dt = built[0].dt if built else 1e-3
        """s, of the first model as it is."""
        check_logged(duration, self.dt, log_every)
        self._check_tags(built)
        self.guidance.check(built)
        self.rotor_count = len(self._models[0].joints)
        if commands is not None:
            self._check_rotors()
            width = built[0].command_width if built else self.rotor_count
            self._base = replace(self._base, commands=as_commands(commands, width))

    def __iter__(self) -> Iterator[Variant]:
        return variants(len(self.names), self.axes)

    def flight(self, variant: Variant) -> FlightPlan:
        """Describe the flight of a variant."""
        index, values = variant
        changed: Dict[str, Any] = {}
        parameters: Dict[str, str] = {}
        scenario = self._scenario
        for axis, value in zip(self.axes, values):
            if axis.name == "scenario":
                scenario = self._scenarios[value]
            elif not axis.tags:
                changed[axis.name] = self._worlds[value] if axis.name == "world" else value
            parameters.update(dict.fromkeys(axis.tags, value))
        varied, tags = without_xacro(parameters, None)
        model = self._read(index, tuple(varied.items()))
        check_names(model, parameters)
        plan = replace(self._base, model=model, parameters={**self._set, **tags}, **changed)
        return self.guidance.onto(plan.befallen(scenario))

    def fly(self, variant: Variant) -> Log:
        """Fly a variant; raises what building or flying it raises."""
        flight = self.flight(variant)
        simulation = flight.simulation()
        with faults_told(simulation):
            return flight.flown_by(simulation)

    def label(self, variant: Variant) -> str:
        """Name of a variant for a person: what sets it apart from the others."""
        model, values = variant
        parts = [self.names[model]] if len(self.names) > 1 else []
        for axis, value in zip(self.axes, values):
            if len(axis.values) > 1 or not parts:
                parts.append(f"{axis.name.split(',')[0].split('.')[-1]} {_short(value)}")
        return ", ".join(parts) or self.names[model]

    def differences(self) -> Dict[str, List[Difference]]:
        """List what sets each model's file apart from the first's, by name of the model."""
        first = self._models[0].document
        return {
            name: differences(first, model.document)
            for name, model in zip(self.names[1:], self._models[1:])
        }

    def as_written(self, axis: Axis) -> str:
        """Tell what the first model's file gives an axis' tags, and where; "" for none."""
        written = facts(self._models[0].document)
        found = [written[tag] for tag in axis.tags if tag in written]
        return "; ".join(f"{fact.text} ({fact.at})" for fact in found)

    def _values(self, name: str) -> List[str]:
        return [value for axis in self.axes if axis.name == name for value in axis.values]

    def _built(self) -> List[Simulation]:
        """Build the models as they are; one that cannot be is a variant that will fail."""
        built = []
        scenario = next(iter(self._scenarios.values()), self._scenario)
        for model in self._models:
            plan = replace(self._base, model=model, parameters=self._set)
            try:
                built.append(plan.befallen(scenario).simulation())
            except QuadcoreError:
                continue
        return built

    def _check_engines(self) -> None:
        known = [name for name, _ in engines()]
        for name in self._values("engine"):
            if name not in known:
                raise InputError(f"vary engine: there is no {_nearest(name, known)}")

    def _check_tags(self, built: Sequence[Simulation]) -> None:
        for simulation in built:
            known = list(WHOLE)
            for plugin in simulation.plugins:
                known += [f"{plugin.name}.{tag.name}" for tag in plugin.parameters]
                known += [f"{plugin.name}.{tag.alias}" for tag in plugin.parameters if tag.alias]
            known += link_values(self._models[0].document)
            for axis in self.axes:
                for tag in axis.tags:
                    if tag not in known and not tag.startswith(f"{XACRO}."):
                        raise InputError(
                            f"vary {tag}: model {simulation.model.name} has no "
                            f"{_nearest(tag, known)}"
                        )
                    if tag in self._taken:
                        raise InputError(f"vary {tag}: it is set as well; keep one")

    def _check_rotors(self) -> None:
        for name, model in zip(self.names, self._models):
            if len(model.joints) != self.rotor_count:
                raise InputError(
                    f"{name}: has {len(model.joints)} rotors, {self.names[0]} has "
                    f"{self.rotor_count}; the same commands cannot fly both"
                )


def _short(value: str) -> str:
    """Leave out digits that a label has no room for."""
    try:
        return f"{float(value):.4g}" if len(value) > 8 else value
    except ValueError:
        return value


def _nearest(name: str, known: Sequence[str]) -> str:
    return f"'{name}'; the nearest is '{difflib.get_close_matches(name, known, 1, 0.0)[0]}'"
