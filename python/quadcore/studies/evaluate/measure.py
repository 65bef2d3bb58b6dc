"""Evaluation of recorded flights next to simulated ones."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from pathlib import Path
from typing import (
    TYPE_CHECKING,
    Any,
    Dict,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Tuple,
    Union,
)

from ..._core import InputError
from ...simulation.engines import STUDY_ENGINE, AnyEngineName
from ...simulation.flight_plan import FlightPlan
from ...simulation.log import Log
from ...support import arguments
from ...support.warning import suppress_warnings
from ..accept_options import accept_options
from ..cases import Case
from ..control_setup import Controllers, make_reference
from ..measured_flight import Outcome
from ..options import CriteriaKeywords, EvaluateOptions, MeasureOptions, Progress
from .evaluate import Evaluation, fly_plan
from .plan import Plan
from .recorded_flight import Alignment, RecordedFlight, align_flight, read_recorded_flight
from .seed_statistics import summarise_seeds

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ...control.keywords import ReferenceName
    from ...control.references import ReferenceLike

RECORDED = "recorded"
"""Engine name of recorded flights in tables."""

File = Union[str, Path, Log]
Files = Union[File, Sequence[File], Mapping[str, Union[File, Sequence[File]]]]
"""One or several logs, or a mapping of labels to logs. Logs with one label are repetitions."""


class Request(NamedTuple):
    """Recorded flights to measure, with their reference and alignment."""

    logs: Sequence[Tuple[str, File]]
    """Label and log of each flight."""
    reference: Any
    controllers: Controllers
    """Controllers to simulate in addition."""
    model: Union[str, Path]
    engine: AnyEngineName
    alignments: Sequence[Alignment]
    """One alignment for each log, or one for all logs."""
    mapping: Union[str, Path, None]


class MeasurePlan(Plan):
    """Plan of the simulated flights, together with the recorded flights.

    Parameters
    ----------
    request
        Recorded flights.
    options
        Options of the simulated flights. The default duration is that of the longest log.

    Raises
    ------
    InputError
        If an input is invalid.
    """

    title = "Measured flights"

    def __init__(self, request: Request, options: MeasureOptions) -> None:
        if isinstance(options.scenario, (list, tuple)) and len(options.scenario) > 1:
            raise InputError("several scenarios are given. Give one, that of the logs.")
        alignments = list(request.alignments)
        if len(alignments) == 1:
            alignments *= len(request.logs)
        if len(alignments) != len(request.logs):
            raise InputError(
                f"{len(alignments)} alignments are given for {len(request.logs)} logs. Give one "
                "for all, or one for each."
            )
        described = _describe_vehicle(request, options)
        with suppress_warnings():  # the plan gives these warnings
            vehicle = described.simulation()
        reference = make_reference(request.reference)
        known = reference.on(vehicle) if hasattr(reference, "on") else reference
        self.recordings: List[RecordedFlight] = []
        for (label, given), alignment in zip(request.logs, alignments):
            file, log = read_recorded_flight(label, given, request.mapping)
            self.recordings.append(
                align_flight(label, file, log, known, alignment, options.duration)
            )
        described = replace(described, reference=known)
        criteria = options.make_criteria()
        self.recorded_outcomes: List[Outcome] = [
            each.measure(described, vehicle, criteria) for each in self.recordings
        ]
        longest = max(float(each.log.time[-1]) for each in self.recordings)
        given_options = {each.name: getattr(options, each.name) for each in fields(options)}
        super().__init__(
            request.controllers,
            request.reference,
            [request.engine],
            [request.model],
            {},
            EvaluateOptions(**{**given_options, "duration": options.duration or longest}),
        )
        self.notes = [each.describe() for each in self.recordings]

    def __len__(self) -> int:
        return super().__len__() if self.control.is_closed_loop else 0

    def make_plan_of_row(self, row: int) -> FlightPlan:
        """Make a plan with the vehicle and world of a row, without its controller."""
        return self.make_plan_without_controller(self[row] if row < len(self) else Case())

    def name_recordings(self) -> List[Dict[str, Any]]:
        """Return the values of the first table columns for each recorded flight."""
        counts: Dict[str, int] = {}
        names = []
        for each in self.recordings:
            counts[each.label] = counts.get(each.label, -1) + 1
            names.append(
                {
                    "controller": each.label,
                    "reference": self.control.references[0],
                    "engine": RECORDED,
                    "model": self.models[0],
                    "scenario": self.scenarios[0],
                    "seed": counts[each.label],
                }
            )
        return names

    def describe(self) -> Dict[str, Any]:
        """Return all settings as plain values."""
        recordings = [
            {
                "label": each.label,
                "file": each.file,
                "begin": each.begin,
                "is_found": each.is_found,
                "rows": len(each.log),
                "spacing": each.spacing,
                "was_even": each.was_even,
            }
            for each in self.recordings
        ]
        return {**super().describe(), "recordings": recordings}


@accept_options(
    MeasureOptions,
    engine=arguments.NAME,
    model=arguments.NAME,
    mapping=arguments.or_none(arguments.NAME),
)
def measure(
    logs: Files,
    reference: Union[ReferenceLike, ReferenceName],
    controllers: Controllers = (),
    *,
    align: Union[Alignment, Sequence[Alignment]] = 0.0,
    mapping: Union[str, Path, None] = None,
    model: Union[str, Path] = "quadrotor",
    engine: AnyEngineName = STUDY_ENGINE,
    **options: Unpack[CriteriaKeywords],
) -> Evaluation:
    """Measure the tracking error of recorded flights, next to simulated ones.

    Parameters
    ----------
    logs
        Files or logs, or a mapping of labels to these. Logs with the same label are repetitions. If
        a label is the name of a simulated controller, tables show both in one column.
    reference
        Reference that the recorded flights followed.
    controllers
        Controllers to simulate with the same reference, as for `evaluate`. Default: none.
    align
        Time in the log at which the reference begins, s, or ``"find"`` for the alignment with the
        minimum RMS tracking error. One value for all logs, or one for each.
    mapping
        Names of the columns in recordings of real flights, as for `Log.of_file`.
    model
        Vehicle that the logs describe.
    engine
        Engine of the simulated flights.
    **options

    Returns
    -------
    Evaluation
        As for `evaluate`. The engine of a recorded flight is "recorded", and its seed is its index
        among the logs with the same label. Metrics that require more than the log, such as the
        share of saturated updates, are NaN.

    Raises
    ------
    InputError
        If a log cannot be read or aligned, or an argument is invalid.
    """
    given = MeasureOptions(**options)
    plan = MeasurePlan(
        Request(
            label_logs(logs),
            reference,
            controllers,
            model,
            engine,
            [align] if isinstance(align, (int, float, str)) else list(align),
            mapping,
        ),
        given,
    )
    return measure_plan(plan, given.progress)


def measure_plan(plan: MeasurePlan, progress: Optional[Progress] = None) -> Evaluation:
    """Simulate the flights of a plan, and add its recorded flights."""
    simulated = fly_plan(plan, progress) if len(plan) else Evaluation([], [], [], [], [])
    return add_recordings(simulated, plan)


def add_recordings(simulated: Evaluation, plan: MeasurePlan) -> Evaluation:
    """Add the recorded flights of a plan to the results of the simulated flights."""
    recorded = plan.name_recordings()
    labels = list(
        dict.fromkeys([*plan.control.controllers, *(name["controller"] for name in recorded)])
    )
    names = [*(plan.name_case(case) for case in plan), *recorded]
    keys = [(labels.index(name["controller"]), int(name["engine"] == RECORDED)) for name in names]
    outcomes = [*simulated.outcomes, *plan.recorded_outcomes]
    units = plan.criteria.units
    table = [
        {
            **name,
            "failure": outcome.failure,
            **dict.fromkeys(units, math.nan),
            **outcome.measures,
        }
        for name, outcome in zip(names, outcomes)
    ]
    groups = summarise_seeds(keys, names, outcomes, units)
    return Evaluation(table, groups, simulated.margins, simulated.poles, outcomes, units)


def label_logs(logs: Files) -> List[Tuple[str, File]]:
    """Return the label and log of each flight; the default label is the file name."""
    if isinstance(logs, Mapping):
        return [(str(label), one) for label, some in logs.items() for one in _to_list(some)]
    return [
        (one.title or f"log {i}" if isinstance(one, Log) else Path(one).name, one)
        for i, one in enumerate(_to_list(logs), start=1)
    ]


def _to_list(logs: Any) -> List[File]:
    found = [logs] if isinstance(logs, (str, Path, Log)) else list(logs)
    if not found:
        raise InputError("no log is given. Give one.")
    return found


def _describe_vehicle(request: Request, options: MeasureOptions) -> FlightPlan:
    with suppress_warnings():  # the plan gives these warnings
        return FlightPlan.of(
            request.model,
            options.world,
            options.xacro_args,
            options.ignore,
            options.parameters,
            engine=request.engine,
        )
