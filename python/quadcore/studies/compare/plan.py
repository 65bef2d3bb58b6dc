"""Flights of a comparison, checked before the first one starts."""

from __future__ import annotations

import math
from contextlib import suppress
from pathlib import Path
from typing import Dict, Iterable, List, Mapping, Optional, Sequence, Union

from ..._core import InputError, QuadcoreError
from ...model.overrides import XACRO, list_link_values
from ...simulation.commands import CommandsLike
from ...simulation.controller_pilot import convert_controller_errors
from ...simulation.engines import list_engines
from ...simulation.flight import check_log_length
from ...simulation.log import Log
from ...simulation.simulation import Simulation
from ...support.parameters import suggest
from ..axes import OF_CONTROLLER, WHOLE, Axis, Values
from ..cases import Case, Cases, make_scenario_axis
from ..control_setup import ControlSetup
from ..design import Design
from ..options import CompareOptions
from ..time_limit import time_limit
from .model_differences import Difference, compare_documents, list_facts

LARGEST = 100_000
"""Maximum number of variants of a comparison."""


class Plan(Cases):
    """Variants of one flight: models, points and seeds.

    Parameters
    ----------
    models, vary, engine, options, commands, wrenches
        As for `compare`.
    control
        One controller and one reference, or neither.

    Raises
    ------
    InputError
        If there are too many variants, a file cannot be read, a tag or engine does not exist, or
        the models need different commands.
    """

    def __init__(
        self,
        models: Sequence[Union[str, Path]],
        vary: Mapping[str, Values],
        engine: str,
        control: ControlSetup,
        options: CompareOptions,
        commands: Optional[CommandsLike] = None,
        wrenches: bool = False,
    ) -> None:
        vary, options = make_scenario_axis(vary, options, least=2)
        design = Design(vary)
        self.axes = design.listed
        if commands is not None and control.is_closed_loop:
            raise InputError("both commands and a controller are given. Give one of them.")
        _check_size(len(models), self.axes)
        known = [name for name, _ in list_engines()]
        for name in design.values("engine"):
            if name not in known:
                raise InputError(
                    f"vary engine: '{name}' does not exist.{suggest(name, known)} "
                    f"Use some of {', '.join(known)}."
                )
        super().__init__(design, control, models, [engine], options, wrenches, LARGEST)
        built = self._build_models()
        first = next(iter(built.values()), None)
        self.dt = 1e-3 if first is None else first.dt
        """Step of the first model, s."""
        check_log_length(options.duration, self.dt, self.steps_per_row(self.dt))
        self._check_tags(built.values())
        self._check_guidance(built)
        self.rotor_count = len(self.variation.models[0].joints)
        if commands is not None:
            self._check_rotors()
            width = self.rotor_count if first is None else first.command_width
            self.set_commands(commands, [width] * len(models))

    def fly(self, case: Case) -> Log:
        """Simulate a variant; errors propagate."""
        with time_limit(self.options.time_limit):
            flight = self.make_plan(case)
            simulation = flight.simulation()
            with convert_controller_errors(simulation):
                return flight.fly_with(simulation)

    def make_label(self, case: Case) -> str:
        """Label a variant by the values that differ between variants."""
        parts = [self.models[case.model]] if len(self.models) > 1 else []
        for axis, value in zip(self.axes, self.design[case.point].values()):
            if len(axis.values) > 1 or not parts:
                parts.append(f"{axis.name.split(',')[0].split('.')[-1]} {_shorten(value)}")
        if len(self.seeds) > 1:
            parts.append(f"seed {self.seeds[case.seed]}")
        return ", ".join(parts) or self.models[case.model]

    def compare_models(self) -> Dict[str, List[Difference]]:
        """List the differences of each model file from the first one, by model."""
        first, *others = self.variation.models
        return {
            name: compare_documents(first.document, model.document)
            for name, model in zip(self.models[1:], others)
        }

    def format_written_value(self, axis: Axis) -> str:
        """Format the values and places of an axis's tags in the first model file."""
        written = list_facts(self.variation.models[0].document)
        found = [written[tag] for tag in axis.tags if tag in written]
        return "; ".join(f"{fact.text} ({fact.at})" for fact in found)

    def _build_models(self) -> Dict[int, Simulation]:
        """Build the unchanged models; a model that cannot be built is omitted and fails later."""
        built = {}
        scenario = {name: value for name, value in self.design[0].items() if name == "scenario"}
        for model in range(len(self.models)):
            with suppress(QuadcoreError):
                built[model] = self.make_vehicle(model, scenario)
        return built

    def _check_tags(self, built: Iterable[Simulation]) -> None:
        taken = self.variation.taken
        for simulation in built:
            known = list(WHOLE)
            for plugin in simulation.plugins:
                known += [f"{plugin.name}.{tag.name}" for tag in plugin.parameters]
                known += [f"{plugin.name}.{tag.alias}" for tag in plugin.parameters if tag.alias]
            known += list_link_values(self.variation.models[0].document)
            for axis in self.axes:
                for tag in axis.tags:
                    if tag not in known and not tag.startswith((f"{XACRO}.", OF_CONTROLLER)):
                        raise InputError(
                            f"vary {tag}: model {simulation.model.name} has no '{tag}'."
                            f"{suggest(tag, known)} List the tags with quadcore info."
                        )
                    if tag in taken:
                        raise InputError(f"vary {tag}: it is also set. Keep one.")

    def _check_guidance(self, built: Mapping[int, Simulation]) -> None:
        """Raise `InputError` if the controller supports none of the models."""
        refused = []
        for model, vehicle in built.items():
            try:
                return self.start_controllers(model, self.design[0], vehicle)
            except InputError as error:
                refused.append(error)
        if refused:
            raise refused[0]

    def _check_rotors(self) -> None:
        for name, model in zip(self.models, self.variation.models):
            if len(model.joints) != self.rotor_count:
                raise InputError(
                    f"{name}: has {len(model.joints)} rotors, {self.models[0]} has "
                    f"{self.rotor_count}. Compare models with the same number of rotors."
                )


def _check_size(models: int, axes: Sequence[Axis]) -> None:
    sizes = [models, *(len(axis.values) for axis in axes)]
    if math.prod(sizes) > LARGEST:
        product = " x ".join(str(size) for size in sizes if size > 1)
        raise InputError(
            f"vary: {product} values make {math.prod(sizes)} flights, more than {LARGEST}. "
            "Vary fewer values."
        )


def _shorten(value: str) -> str:
    """Shorten a number for a label."""
    try:
        return f"{float(value):.4g}" if len(value) > 8 else value
    except ValueError:
        return value
