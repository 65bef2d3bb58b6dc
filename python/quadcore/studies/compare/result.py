"""Results of a comparison."""

from __future__ import annotations

from typing import (
    Any,
    Callable,
    Dict,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Tuple,
    Union,
)

import numpy as np

from ..._core import InputError, QuadcoreError
from ...report.html_table import SHOWN_ROWS, html_table, html_title
from ...simulation.log import Log
from ..flight_differences import compute_final_and_max, list_states
from ..table import NOT_FLOWN, choose_display_unit, count_outcomes, format_number
from ..tracking_metrics import compute_errors, compute_rms_and_max
from .model_differences import Difference
from .plan import Plan

Progress = Callable[[int, int], None]
Keep = Callable[[int, Log], Any]
Measured = Tuple[Sequence[float], np.ndarray]
"""RMS and maximum tracking error, m, and the result of `compute_final_and_max`."""
Outcome = Tuple[Measured, Any]


class Comparison(NamedTuple):
    """Results of a comparison.

    Attributes
    ----------
    table : ndarray
        Structured array with a row per variant. Columns: ``model``, each axis, ``failure`` ("" for
        success), and ``final_STATE`` and ``max_STATE`` for each of `states`, NaN after a failure.
        With a controller also ``rms_error`` and ``max_error``, the tracking error (m).
    logs : list
        `Log` of each variant, None after a failure; empty if logs are not kept.
    states : dict of str to str
        Unit of each compared state. ``position``, ``velocity`` and ``rates`` are norms of
        difference vectors. ``attitude`` is the angle between the two attitudes.
    against : int or None
        Row of the baseline.
    differences : dict of str to list of Difference
        Differences of each model file from the first one, by model.
    refused : int
        Number of variants with invalid input, which did not run.
    """

    table: np.ndarray
    logs: List[Any]
    states: Dict[str, str]
    against: Optional[int]
    differences: Dict[str, List[Difference]]
    refused: int

    def __repr__(self) -> str:
        return f"<Comparison, {count_outcomes(self.table['failure'].tolist())}>"

    def _repr_html_(self) -> str:
        names = self.table.dtype.names or ()
        varied = names[: names.index("failure")]
        axes = [name for name in varied if len(set(self.table[name])) > 1]
        list_states = list(self.states)[:4]
        units = {name: choose_display_unit(self.states[name]) for name in list_states}
        heads = [*axes, *(f"max {name} ({unit})" for name, (unit, _) in units.items())]
        rows = []
        for row in self.table[:SHOWN_ROWS]:
            cells = [format_number(row[f"max_{name}"] * units[name][1]) for name in list_states]
            cells = [row["failure"]] if row["failure"] else cells
            rows.append([*(str(row[axis]) for axis in axes), *cells])
        return html_title(self) + html_table(heads, rows, len(self.table))


def measure(plan: Plan, against: Log, log: Log) -> Measured:
    """Compute the tracking error of a flight and its difference from the baseline."""
    away = compute_errors(log) if plan.control.is_closed_loop else np.array([np.nan])
    return compute_rms_and_max(away), compute_final_and_max(against, log)


class Tally:
    """Results of a comparison so far."""

    def __init__(self, plan: Plan, keep: Optional[Keep], progress: Optional[Progress]) -> None:
        self.keep = keep
        self.done = 0
        self.against: Optional[int] = None
        self._plan, self._progress = plan, progress
        self._refused = 0
        self._errors = np.full((len(plan), 2), np.nan)
        self._allocate(plan.rotor_count)
        self._failures = [NOT_FLOWN] * len(plan)
        self._kept: List[Any] = [] if keep is None else [None] * len(plan)

    def set_baseline(self, row: int, log: Log) -> None:
        """Set the baseline and the number of its rotors."""
        self.against = row
        self._allocate(log.rotor_velocity.shape[1])

    def add_outcome(self, row: int, outcome: Union[Outcome, QuadcoreError]) -> None:
        """Add the outcome of a flight."""
        if isinstance(outcome, QuadcoreError):
            self._failures[row] = str(outcome)
            self._refused += isinstance(outcome, InputError)
        else:
            self._errors[row], self._metrics[row] = outcome[0]
            if self._kept:
                self._kept[row] = outcome[1]
            self._failures[row] = ""
        self.done += 1
        if self._progress is not None:
            self._progress(self.done, len(self._plan))

    def make_comparison(self) -> Comparison:
        """Return the results."""
        plan = self._plan
        points = [plan.design[case.point] for case in plan]
        columns: Dict[str, Any] = {
            "model": [plan.models[case.model] for case in plan],
            **{
                name: _convert_numbers([point[name] for point in points])
                for name in plan.design.names
            },
        }
        if len(plan.seeds) > 1:
            columns["seed"] = [plan.seeds[case.seed] for case in plan]
        columns["failure"] = self._failures
        if plan.control.is_closed_loop:
            columns["rms_error"], columns["max_error"] = self._errors.T
        for i, kind in enumerate(("final", "max")):
            for j, state in enumerate(self._states):
                columns[f"{kind}_{state}"] = self._metrics[:, i, j]
        return Comparison(
            _make_structured_array(columns),
            self._kept,
            self._states,
            self.against,
            plan.compare_models(),
            self._refused,
        )

    def _allocate(self, rotor_count: int) -> None:
        self._states = list_states(rotor_count)
        self._metrics = np.full((len(self._plan), 2, len(self._states)), np.nan)


def _convert_numbers(values: Sequence[str]) -> np.ndarray:
    """Convert texts to numbers if all of them are numbers."""
    try:
        return np.array([float(value) for value in values])
    except ValueError:
        return np.array(values)


def _make_structured_array(columns: Mapping[str, Sequence[Any]]) -> np.ndarray:
    arrays = {name: np.asarray(values) for name, values in columns.items()}
    table = np.empty(
        len(arrays["model"]), dtype=[(name, array.dtype) for name, array in arrays.items()]
    )
    for name, array in arrays.items():
        table[name] = array
    return table
