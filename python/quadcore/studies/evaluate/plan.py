"""Flights of an evaluation."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Dict, Iterator, Mapping, Sequence, Tuple, Union

from ...control import references
from ...control.built_in import BuiltInController
from ...simulation.engines import exerts_wrenches
from ...simulation.flight_plan import FlightPlan
from ...simulation.scenario_events import Event
from ...support.arguments import MEASURED
from ..axes import Values
from ..cases import Case, Cases, check_models, label_point, make_scenario_axis
from ..control_setup import Controllers, ControlSetup, References, add_labels
from ..design import Design
from ..options import EvaluateOptions
from . import margins, trial


class Plan(Cases):
    """Checked combinations of controllers, references, engines, models, scenarios and seeds.

    Parameters
    ----------
    controllers, references_, engines, models, vary, options
        As for `evaluate`. Each combination of the values of `vary` is a scenario.

    Raises
    ------
    InputError
        If an input is invalid. An error of a user-defined controller only fails its flights.
    """

    title = "Evaluation of controllers"
    """Title of the page."""
    notes: Sequence[str] = ()
    """Remarks for the terminal and the page, one line each."""

    def __init__(
        self,
        controllers: Controllers,
        references_: References,
        engines: Sequence[str],
        models: Sequence[Union[str, Path]],
        vary: Mapping[str, Values],
        options: EvaluateOptions,
    ) -> None:
        vary, options = make_scenario_axis(vary, options)
        design = Design(vary)
        check_models(models, design)
        control = ControlSetup(
            add_labels("controller", controllers, BuiltInController),
            add_labels("reference", references_, references.Shape),
            options.controller_rate,
            options.delay,
            on_reference=options.spawn is None,
            privileged=options.privileged,
        )
        super().__init__(design, control, models, engines, options)
        time = options.computation_time
        self.measures_times = time == MEASURED
        """Whether to measure the computation times before the flights."""
        if time is not None and not self.measures_times:
            self.set_computation_times([float(time)] * len(control.controllers))
        self.draws_spectra = options.spectra
        self.measures_loops = options.frequency_response
        self.criteria = options.make_criteria()
        self.scenarios = [label_point(point) for point in design]
        self.lacking = trial.list_missing_effects(self.check()[0])

    @property
    def omitted_margins(self) -> str:
        """Margins that are not searched and the reason, in one line; "" if all are searched."""
        labels = [self.control.controllers[i] for i in self.plugins]
        return margins.describe_omitted(self.models[0], self.lacking, labels)

    @property
    def plugins(self) -> Sequence[int]:
        """Indices of the C++ plugin controllers."""
        return [i for i in range(len(self.control.things)) if self.control.is_plugin(i)]

    def set_computation_times(self, times: Sequence[float]) -> None:
        """Add computation times (s) to the delays of the controllers; NaN adds no delay."""
        known = {i: time for i, time in enumerate(times) if not math.isnan(time)}
        self.control.computation_times.update(known)
        if not self.measures_times:
            return
        labels = self.control.controllers
        found = [f"{labels[i]} {1e3 * time:.3g} ms" for i, time in known.items()]
        missing = {
            label: "it is a plugin" if self.control.is_plugin(i) else "its flight failed"
            for i, label in enumerate(labels)
            if i not in known
        }
        self.notes = [
            f"Commands are delayed by computation times measured on this machine, which differ in "
            f"every study: {', '.join(found) or 'none'}.",
            *(
                f"The computation time of {label} is not measured, because {reason}."
                for label, reason in missing.items()
            ),
        ]

    def name_case(self, case: Case) -> Dict[str, Any]:
        """Return the names of a case, which are the first columns of the table."""
        return {
            **self.name_sides(case),
            "scenario": self.scenarios[case.point],
            "seed": self.seeds[case.seed],
        }

    def make_plan_of_row(self, row: int) -> FlightPlan:
        """Make the plan of the flight in a row of the table, without its controller."""
        return self.make_plan_without_controller(self[row])

    def list_built_in_flights(self) -> Iterator[Tuple[Dict[str, str], FlightPlan]]:
        """Yield the names and a flight of each built-in controller on each model.

        Engines that run the plugins share an entry.
        """
        of_plugins = [name for name in self.engines if exerts_wrenches(name)]
        several = [of_plugins, *([name] for name in self.engines if name not in of_plugins)]
        for row, label in enumerate(self.control.controllers):
            for model, vehicle in enumerate(self.models):
                for flown in several:
                    if flown and not self.control.is_user_code(row):
                        engine = self.engines.index(flown[0])
                        flight = self.make_plan(Case(row, engine=engine, model=model))
                        names = {"controller": label, "model": vehicle, "engine": ", ".join(flown)}
                        yield names, flight

    def list_events(self) -> Dict[str, Sequence[Event]]:
        """Return the events of each scenario by name."""
        read = self.variation.scenarios
        found = {
            name: read[each.get("scenario")] for name, each in zip(self.scenarios, self.design)
        }
        return {name: scenario.events for name, scenario in found.items() if scenario is not None}

    def describe(self) -> Dict[str, Any]:
        """Return all settings except the parameters of the controllers, as plain values."""
        labels = self.control.controllers
        times = {labels[i]: time for i, time in self.control.computation_times.items()}
        return {
            "controllers": self.control.controllers,
            "references": self.control.references,
            "engines": self.engines,
            "models": self.models,
            "scenarios": self.scenarios,
            **self.list_settings(),
            **({"computation_times": times} if times else {}),
        }
