"""Changes of a flight at a point: model, tags, world, engine and scenario."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Union

from .._core import InputError, Model, World, parse_number
from ..model.description import read_model, read_world
from ..model.overrides import XACRO, check_names, split_xacro_arguments
from ..simulation.flight_plan import FlightPlan
from ..simulation.scenarios import Scenario
from ..simulation.scenarios import read_scenario as read_scenario
from ..support.values import format_value
from .axes import OF_CONTROLLER, WHOLE
from .design import Design

_READ = 16  # maximum number of cached models


class Variation:
    """Models and common settings of all flights, and their changes at each point.

    Parameters
    ----------
    models
        Files or names of built-in models.
    design
        Points of the study. Their worlds and scenarios are read.
    parameters, xacro_args, ignore
        As for `Simulation`.
    scenario
        Scenario of the points that have none.
    wind
        Velocity of a constant wind in all flights, world axes, m/s.
    at
        Location on Earth of the worlds of the points; see `read_world`.
    """

    def __init__(
        self,
        models: Sequence[Union[str, Path]],
        design: Design,
        parameters: Optional[Mapping[str, Any]],
        xacro_args: Optional[Mapping[str, object]],
        ignore: Sequence[str],
        scenario: Union[str, Path, Scenario, None],
        wind: Optional[Sequence[float]] = None,
        at: Optional[Sequence[float]] = None,
    ) -> None:
        arguments, given = split_xacro_arguments(parameters, xacro_args)
        self.arguments = arguments
        self.set = {key: format_value(value) for key, value in given.items()}
        """Values that all flights share, by ``PLUGIN.TAG``, ``LINK.mass`` and so on."""
        self._wind = wind
        self._read = lru_cache(_READ)(
            lambda i, varied: read_model(models[i], {**arguments, **dict(varied)}, ignore)
        )
        self.models: List[Model] = [self._read(i, ()) for i in range(len(models))]
        self.worlds: Dict[str, World] = {
            name: read_world(name, ignore, at) for name in dict.fromkeys(design.values("world"))
        }
        self.scenarios: Dict[Optional[str], Optional[Scenario]] = {None: read_scenario(scenario)}
        names = dict.fromkeys(design.values("scenario"))
        self.scenarios.update((name, read_scenario(name)) for name in names)

    @property
    def taken(self) -> List[str]:
        """Names of the parameters that are set for all flights."""
        return [*self.set, *(f"{XACRO}.{name}" for name in self.arguments)]

    def apply(self, plan: FlightPlan, model: int, point: Mapping[str, str]) -> FlightPlan:
        """Apply the values of a point to a plan, except for the values of the controller."""
        changed: Dict[str, Any] = {}
        parameters = dict(self.set)
        for name, value in point.items():
            if name == "world":
                changed["world"] = self.worlds[value]
            elif name == "engine":
                changed["engine"] = value
            elif name not in WHOLE and not name.startswith(OF_CONTROLLER):
                parameters.update(dict.fromkeys(name.split(","), value))
        varied, tags = split_xacro_arguments(parameters, None)
        read = self._read(model, tuple(varied.items()))
        check_names(read, parameters)
        plan = replace(plan, **changed, model=read, parameters=tags)
        return plan.with_scenario(self.scenarios[point.get("scenario")]).with_wind(self._wind)


def pick_controller_values(point: Mapping[str, str]) -> Dict[str, float]:
    """Return the controller values of a point.

    Raises
    ------
    InputError
        If a value is not a number.
    """
    found = {}
    for name, text in point.items():
        if name.startswith(OF_CONTROLLER):
            value = parse_number(text)
            if value is None:
                raise InputError(f"vary {name}: '{text}' is not a finite number. Write one.")
            found[name[len(OF_CONTROLLER) :]] = value
    return found
