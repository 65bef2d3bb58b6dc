"""Page of a tuning, and logs of a held-out flight with start gains and tuned gains."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, List, Mapping, Tuple, Union

from ..._core import QuadcoreError
from ...model.obstacles import draw_world
from ...model.visuals import read_vehicle
from ...report.drawing import Drawing, save_drawings
from ...simulation.log import Log
from ...support.warning import suppress_warnings
from ..executor import run_contained
from ..flight_folder import (
    DOCUMENT,
    WrittenFlight,
    name_log,
    remove_flights,
    write_flights,
    write_logs,
)
from ..step_error import compute_step_error
from ..table import format_number, format_settings
from ..time_limit import time_limit
from .problem import Problem
from .search import Tuning
from .trials import Flown, Trial, judge

GAINS = "gains.yaml"
PAGE = "report.html"
FILES = (DOCUMENT, PAGE)
"""Files in the folder, in addition to logs, models and plots."""

_START, _TUNED = "start", "tuned"
_SEARCH = ("engine", "duration", "dt", "models", "tuned_on", "optimiser", "seed", "budget", "vary")


def write(found: Tuning, problem: Problem, folder: Path, plots: bool = True) -> List[Path]:
    """Write ``run.json``, the logs, the model, the plots and the page.

    Parameters
    ----------
    found, problem
        Result, and problem that it solves.
    folder
        Existing folder.
    plots
        Whether to draw plots.
    """
    from ...report.page import write_page  # jinja2 is slow to import

    trial = problem.held_out[0]
    gains = {_START: problem.start, _TUNED: {n: found.gains.parameters[n] for n in problem.start}}
    flown = _fly(problem, list(gains.items()), trial)
    before = _measure(problem, problem.start)
    remove_flights(folder)
    write_logs(folder, [log for _, log in flown])
    listed = [
        WrittenFlight(
            f"{trial.label}: {name}", name_log(number), trial.plan.model, trial.plan.world
        )
        for number, (name, _) in enumerate(flown, start=1)
    ]
    written = write_flights(folder, listed)
    images = _draw(found) if plots else {}
    written += save_drawings(folder, images)
    step_error = compute_step_error(
        trial.label,
        trial.plan if problem.runs_user_code else problem.make_plan(trial, gains[_TUNED]),
        problem.options.time_limit,
    )
    history = found.gains.history
    write_page(
        folder / PAGE,
        "tune.html",
        title=f"Tuning of {found.gains.law}",
        verdict=f"Tuning reduces the mean RMS tracking error from {format_number(found.start)} to "
        f"{format_number(found.error)} m; held out, {trial.label}: from {before[trial.label]} to "
        f"{format_number(found.held_out[trial.label])} m.",
        summary=f"{len(found.evaluations)} gain sets tried, {found.refused} refused because a "
        "held-out flight failed or did not return from an offset.",
        conditions=f"{', '.join(problem.models)}, engine {trial.plan.engine}, "
        f"{trial.plan.duration:g} s; search on {', '.join(history['tuned_on'])}.",
        step_error="" if step_error is None else step_error.describe(),
        watched=trial.label,
        player=_make_player(flown, trial),
        gains=[_describe_gain(name, gains[_START][name], x) for name, x in gains[_TUNED].items()],
        errors=[
            {
                "label": "search, mean of all flights",
                "start": format_number(found.start),
                "tuned": format_number(found.error),
            },
            *(
                {"label": f"held out: {label}", "start": before[label], "tuned": format_number(x)}
                for label, x in found.held_out.items()
            ),
        ],
        settings=format_settings({name: history.get(name) for name in _SEARCH}),
        plots=[{"name": name, "data": data} for name, data in images.items()],
    )
    return [*written, folder / PAGE]


def _describe_gain(name: str, start: float, value: float) -> Dict[str, str]:
    numbers = {"start": start, "value": value, "ratio": value / start}
    return {"name": name, **{key: format_number(number) for key, number in numbers.items()}}


def _fly(
    problem: Problem, gains: List[Tuple[str, Mapping[str, float]]], trial: Trial
) -> List[Tuple[str, Log]]:
    """Simulate a trial with several sets of gains; flights that fail are omitted."""
    logs: Dict[str, Log] = {}

    def fly(each: Tuple[str, Mapping[str, float]]) -> Log:
        with suppress_warnings(), time_limit(problem.options.time_limit):
            return problem.watch(trial, each[1])

    def take(index: int, log: Union[Log, QuadcoreError]) -> None:
        if not isinstance(log, QuadcoreError):
            logs[gains[index][0]] = log

    run_contained(fly, gains, take, problem.options.processes, apart=problem.runs_user_code)
    return [(name, logs[name]) for name, _ in gains if name in logs]


def _measure(problem: Problem, gains: Mapping[str, float]) -> Dict[str, str]:
    """Measure the RMS tracking error with these gains in each held-out trial."""
    trials = problem.held_out
    errors: Dict[str, str] = {}

    def fly(trial: Trial) -> Flown:
        with suppress_warnings(), time_limit(problem.options.time_limit):
            return problem.simulate(trial, gains)

    def take(index: int, found: Union[Flown, QuadcoreError]) -> None:
        text = "failed"
        if not isinstance(found, QuadcoreError):
            judged = judge(trials[index], found, problem.options.failure_distance)
            text = text if judged.failure else format_number(judged.error)
        errors[trials[index].label] = text

    run_contained(fly, trials, take, problem.options.processes, apart=problem.runs_user_code)
    return errors


def _make_player(flown: List[Tuple[str, Log]], trial: Trial) -> Any:
    from ...report.player import PlayerFlight, make_section  # jinja2 is slow to import

    if not flown:
        return ""
    with suppress_warnings():
        vehicle = read_vehicle(trial.plan.model)
    shown = [PlayerFlight(name, log, vehicle) for name, log in flown]
    return make_section(shown, draw_world(trial.plan.world))


def _draw(found: Tuning) -> Dict[str, Drawing]:
    """Draw the objective of each gain set."""
    from ...report.plots import finish  # matplotlib is slow to import
    from .plots import draw_search

    return {"search": finish(draw_search(found.evaluations))}
