"""Search for the best gains."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from ..._core import InputError, QuadcoreError
from ...control.gains import Gains
from ...support.warning import suppress_warnings
from ..executor import contain_errors, run_contained
from ..options import Progress
from ..time_limit import time_limit
from .problem import Problem
from .trials import Flown, Trial, TrialResult, judge, judge_return

OBJECTIVE = (
    "mean over the cases, from the start of the reference and from an offset, of the RMS tracking "
    "error, m"
)

_SPREAD = 0.8  # initial standard deviation of the logarithm of a gain: a factor of 2.2


class Tuning(NamedTuple):
    """Result of a tuning."""

    gains: Gains
    """Best gains, with which all held-out cases succeed, and the history of the search."""
    error: float
    """`OBJECTIVE` with these gains."""
    start: float
    """`OBJECTIVE` with the start gains."""
    evaluations: List[float]
    """`OBJECTIVE` of each candidate; the first one is the start."""
    held_out: Dict[str, float]
    """RMS tracking error in each held-out case, m."""
    refused: int
    """Number of candidates that improved the training cases but failed a held-out case."""


class Search:
    """State of a gain search."""

    def __init__(
        self,
        problem: Problem,
        budget: int,
        progress: Optional[Progress],
    ) -> None:
        if budget < 1:
            raise InputError(f"budget is {budget}. Give at least 1.")
        self.evaluations: List[float] = []
        self.refused = 0
        self.refusal = ""
        self._problem = problem
        self._budget = budget
        options = problem.options
        self._seed = options.seed
        self._limit, self._processes = options.time_limit, options.processes
        self._progress = progress
        self._best: Optional[Tuple[float, Dict[str, float], Dict[str, float]]] = None
        """Objective, gains, and error of each held-out case."""
        self._least = math.inf

    def run(self, cma: Any) -> None:
        """Search until the budget is used up."""
        start = self._problem.start
        self._check(start)
        self._try([start])
        # Use a separate generator, because the global one of NumPy belongs to the caller.
        drawn = np.random.default_rng(self._seed)
        strategy = cma.CMAEvolutionStrategy(
            np.zeros(len(start)),
            _SPREAD,
            {
                "verbose": -9,
                "seed": np.nan,
                "randn": lambda *shape: drawn.standard_normal(shape),
                "maxiter": np.inf,
            },
        )
        while len(self.evaluations) < self._budget:
            points = strategy.ask()
            strategy.tell(points, self._try([self._scale_gains(point) for point in points]))

    def _check(self, start: Mapping[str, float]) -> None:
        """Raise the error of an invalid controller or vehicle before the search."""
        problem = self._problem
        if not problem.runs_user_code:
            for case in problem.training:
                problem.fly(case, start)
            return
        errors: List[QuadcoreError] = []

        def fly(index: int) -> Flown:
            with suppress_warnings(), time_limit(self._limit):
                return problem.simulate(problem.training[index], start)

        def take(_: int, outcome: Union[Flown, QuadcoreError]) -> None:
            if isinstance(outcome, InputError):
                errors.append(outcome)

        self._run(fly, len(problem.training), take)
        if errors:
            raise errors[0]

    def make_tuning(self, cma: Any, ended: str) -> Optional[Tuning]:
        """Return the best result so far, or None."""
        from ... import __version__  # __version__ is defined after this module is imported

        if self._best is None:
            return None
        error, gains, held_out = self._best
        history = {
            "start": dict(self._problem.start),
            "objective": OBJECTIVE,
            "models": self._problem.models,
            "tuned_on": [case.label for case in self._problem.training if not case.has_offset],
            "held_out": {label: float(value) for label, value in held_out.items()},
            **self._problem.list_settings(),
            "quadcore": __version__,
            "optimiser": f"cma {cma.__version__}",
            "seed": self._seed,
            "budget": self._budget,
            "refused": self.refused,
            "best": error,
            "evaluations": list(self.evaluations),
        }
        if ended:
            history["ended"] = ended
        found = replace(self._problem.describe_controller(gains), history=history)
        start = self.evaluations[0]
        return Tuning(found, error, start, list(self.evaluations), held_out, self.refused)

    def _scale_gains(self, point: np.ndarray) -> Dict[str, float]:
        start = self._problem.start
        return {name: value * math.exp(x) for (name, value), x in zip(start.items(), point)}

    def _try(self, candidates: Sequence[Mapping[str, float]]) -> List[float]:
        """Evaluate candidates, and check the best one if it improves on all earlier candidates."""
        training = self._problem.training
        flights = self._fly([(case, gains) for gains in candidates for case in training])
        count = len(training)
        errors = [
            float(np.mean([flown.error for flown in flights[i : i + count]]))
            for i in range(0, len(flights), count)
        ]
        self.evaluations += errors
        best = int(np.argmin(errors))
        if errors[best] < self._least:
            self._judge(errors[best], dict(candidates[best]))
        if self._progress is not None:
            self._progress(min(len(self.evaluations), self._budget), self._budget)
        return errors

    def _judge(self, error: float, gains: Dict[str, float]) -> None:
        problem = self._problem
        flights = self._fly([(case, gains) for case in problem.held_out])
        held_out = {}
        for case, flown in zip(problem.held_out, flights):
            if flown.failure:
                return self._refuse(f"fail on {case.label}: {flown.failure}")
            held_out[case.label] = flown.error
        left: List[str] = [""] * len(problem.return_trials)

        def take(index: int, outcome: Union[List[Flown], QuadcoreError]) -> None:
            failed = isinstance(outcome, QuadcoreError)
            left[index] = str(outcome) if failed else judge_return(outcome)  # type: ignore

        def fly(index: int) -> List[Flown]:
            with suppress_warnings(), time_limit(self._limit):
                return problem.simulate_return(problem.return_trials[index], gains)

        self._run(fly, len(left), take)
        for case, failure in zip(problem.return_trials, left):
            if failure:
                return self._refuse(f"do not return to {case.label} from an offset: {failure}")
        self._least = error
        self._best = error, gains, held_out

    def _refuse(self, reason: str) -> None:
        self.refused += 1
        self.refusal = f"the best candidates {reason}"

    def _run(self, fly: Callable[[int], Any], count: int, take: Callable[[int, Any], None]) -> None:
        """Call a function for each index; flights with user code share no state."""
        apart = self._problem.runs_user_code
        run_contained(fly, range(count), take, self._processes, apart=apart)

    def _fly(self, flights: Sequence[Tuple[Trial, Mapping[str, float]]]) -> List[TrialResult]:
        outcomes: List[Optional[TrialResult]] = [None] * len(flights)
        problem = self._problem
        groups = problem.group(flights)

        def describe(error: QuadcoreError) -> TrialResult:
            # Gains that the controller rejects get the worst result.
            return TrialResult(problem.options.failure_distance, str(error))

        def take(task: int, found: Union[List[Any], QuadcoreError]) -> None:
            if isinstance(found, QuadcoreError):
                found = [describe(found)] * len(groups[task])
            for index, one in zip(groups[task], found):
                if isinstance(one, Flown):
                    one = judge(flights[index][0], one, problem.options.failure_distance)
                outcomes[index] = one

        def fly(task: int) -> List[Any]:
            chosen = [flights[index] for index in groups[task]]
            if len(chosen) == 1:
                return [fly_one(chosen[0])]
            together = problem.fly_together(chosen, self._limit)
            return together or [fly_contained(flight) for flight in chosen]

        def fly_one(flight: Tuple[Trial, Mapping[str, float]]) -> Flown:
            with suppress_warnings(), time_limit(self._limit):
                return problem.simulate(*flight)

        def fly_contained(flight: Tuple[Trial, Mapping[str, float]]) -> Any:
            try:
                return contain_errors(fly_one)(flight)
            except QuadcoreError as error:
                return describe(error)

        # Pass indices, because a reference may be a function that cannot be pickled.
        self._run(fly, len(groups), take)
        return outcomes  # type: ignore[return-value]
