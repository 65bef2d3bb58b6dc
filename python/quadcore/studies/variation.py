"""What a point of the axes changes in a flight: model, tags, world, scenario, controller."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any, Dict, Iterable, Mapping, Optional, Sequence, Tuple, Union

from .._core import InputError, Model, World, parse_number
from ..control.controller import give
from ..model.description import read_model, read_world
from ..model.overrides import check_names, without_xacro
from ..simulation.flight_plan import FlightPlan
from ..simulation.scenarios import Scenario
from ..simulation.scenarios import read as read_scenario
from ..support.values import text_of

OF_CONTROLLER = "controller."

_READ = 16  # models that are kept as they were read


class Variation:
    """Models, and what is common to all flights, with what may be changed in them.

    Parameters
    ----------
    models
        Files or names of shipped models.
    parameters, xacro_args, ignore
        As for `Simulation`.
    """

    def __init__(
        self,
        models: Sequence[Union[str, Path]],
        parameters: Optional[Mapping[str, Any]] = None,
        xacro_args: Optional[Mapping[str, object]] = None,
        ignore: Sequence[str] = (),
    ) -> None:
        arguments, given = without_xacro(parameters, xacro_args)
        self.arguments, self.ignore = arguments, ignore
        self.set = {key: text_of(value) for key, value in given.items()}
        """Values that all flights have, by ``PLUGIN.TAG``, ``LINK.mass`` or the like."""
        self._read = lru_cache(_READ)(
            lambda i, varied: read_model(models[i], {**arguments, **dict(varied)}, ignore)
        )
        self.worlds: Dict[str, World] = {}
        self.scenarios: Dict[Optional[str], Optional[Scenario]] = {None: None}

    def read(self, model: int) -> Model:
        """Read a model as nothing changes it."""
        found: Model = self._read(model, ())
        return found

    def provide(self, worlds: Iterable[str], scenarios: Iterable[str]) -> None:
        """Read what points will name."""
        self.worlds.update((name, read_world(name, self.ignore)) for name in dict.fromkeys(worlds))
        self.scenarios.update((name, read_scenario(name)) for name in dict.fromkeys(scenarios))

    def applied(self, plan: FlightPlan, model: int, point: Mapping[str, str]) -> FlightPlan:
        """Make a flight of a model as a point has it; its controller is left as it is."""
        changed: Dict[str, Any] = {}
        parameters = dict(self.set)
        for name, value in point.items():
            if name == "world":
                changed["world"] = self.worlds[value]
            elif name != "scenario" and not name.startswith(OF_CONTROLLER):
                parameters.update(dict.fromkeys(name.split(","), value))
        varied, tags = without_xacro(parameters, None)
        read = self._read(model, tuple(varied.items()))
        check_names(read, parameters)
        plan = replace(plan, **changed, model=read, parameters=tags)
        return plan.befallen(self.scenarios[point.get("scenario")])


def give_all(controller: Any, values: Iterable[Tuple[str, Any]]) -> Any:
    """Give a controller its rate, delay and parameters, as far as they are told."""
    for name, value in values:
        if value is not None:
            give(controller, name, value)
    return controller


def is_of_controller(name: str) -> bool:
    """Tell whether an axis, perhaps of several names, varies a controller."""
    return any(part.startswith(OF_CONTROLLER) for part in name.split(","))


def of_controller(point: Mapping[str, str]) -> Dict[str, float]:
    """Tell what a point changes in a controller.

    Raises
    ------
    InputError
        A value that is no number.
    """
    found = {}
    for name, text in point.items():
        if name.startswith(OF_CONTROLLER):
            value = parse_number(text)
            if value is None:
                raise InputError(f"vary {name}: '{text}' is not a finite number")
            found[name[len(OF_CONTROLLER) :]] = value
    return found
