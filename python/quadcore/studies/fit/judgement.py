"""Judgement of a model by its predictions of flights that were not used in the fit."""

from __future__ import annotations

from typing import Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from ..._core import FlightError
from ...simulation.log import Log
from .fitted_model import FittedModel
from .flight_fit import calibrate_trims
from .predictor import Predictor
from .prepared import PreparedFlight
from .windows import (
    CHANNELS,
    HORIZONS,
    INSTANTS,
    Windows,
    compute_errors,
    compute_rms,
    make_windows,
    predict_constant,
)

CONSTANT = "constant velocity and rates"
_CALIBRATED = 0.3
"""Fraction of a flight, from its start, that only calibrates the trims. The rest is judged."""
_MEMORY, _BLOCK = 10.0, 3.0
"""Time before a block, for the windows that give its trims, and duration of a block, s."""
_FEWEST = 5
"""Minimum number of windows for the trims; if `_MEMORY` contains fewer, all earlier ones count."""
DECISIVE = 0.25
"""Horizon at which the model must be better than the baselines, s."""
_COMPARED = {True: ("position", "attitude"), False: ("rates",)}


class Judgement(NamedTuple):
    """Prediction errors over the horizon.

    Attributes
    ----------
    errors : dict of str to dict of str to ndarray (instants,)
        RMS error of each model and baseline by channel, in the units of `CHANNELS`.
    windows : Windows
        Judged windows.
    predicted : dict of str to ndarray
        States predicted by the first model.
    """

    errors: Dict[str, Dict[str, np.ndarray]]
    windows: Windows
    predicted: Dict[str, np.ndarray]

    def list_rows(self) -> List[Tuple[str, str, str, List[float]]]:
        """List the model, channel, unit, and errors at `HORIZONS`."""
        places = [INSTANTS.index(horizon) for horizon in HORIZONS]
        return [
            (model, channel, CHANNELS[channel], [float(values[i]) for i in places])
            for model, of_channels in self.errors.items()
            for channel, values in of_channels.items()
        ]

    def check(self) -> None:
        """Raise `FlightError` if the first model is worse than any other at 0.25 s."""
        model, *baselines = self.errors
        place = INSTANTS.index(DECISIVE)
        for channel in _COMPARED["position" in self.windows.states]:
            found = self.errors[model][channel][place]
            for baseline in baselines:
                other = self.errors[baseline][channel][place]
                if not found <= other:
                    raise FlightError(
                        f"{channel} at {DECISIVE:g} s: the model errs by {found:.3g} "
                        f"{CHANNELS[channel]}, {baseline} by {other:.3g}. Fit other flights or "
                        "other parameters, or add --force."
                    )


def judge_models(
    models: Mapping[str, Tuple[FittedModel, Mapping[str, float]]],
    flights: Sequence[PreparedFlight],
) -> Judgement:
    """Predict flights with several models and with a baseline.

    Delay, rotor speed factor and constant torque depend on battery and trim, and drift during a
    flight. Each prediction therefore uses values calibrated on the preceding 10 s. The first 30 %
    of a flight are used only for calibration, and the rest is judged.

    Parameters
    ----------
    models
        For each name, a model with values of its free parameters and inputs. The first model is
        judged.
    flights
        Prepared flights.
    """
    windows = make_windows(flights)
    of_flights = [windows.choose_flight(number) for number in range(len(flights))]
    judged = windows.choose(np.concatenate([w.start >= _find_begin(w) for w in of_flights]))
    errors: Dict[str, Dict[str, np.ndarray]] = {}
    first: Optional[Dict[str, np.ndarray]] = None
    for name, (fitted, values) in models.items():
        parts = [part for each in of_flights for part in _predict_blocks(fitted, values, each)]
        predicted = {key: np.concatenate([part[key] for part in parts]) for key in parts[0]}
        errors[name] = compute_rms(compute_errors(judged, predicted))
        first = predicted if first is None else first
    errors[CONSTANT] = compute_rms(compute_errors(judged, predict_constant(judged)))
    assert first is not None
    return Judgement(errors, judged, first)


def _find_begin(windows: Windows) -> float:
    """Return the start time of the judged part of a flight, s."""
    start = windows.start
    return float(start[0] + _CALIBRATED * (start[-1] - start[0]))


def _predict_blocks(
    fitted: FittedModel, values: Mapping[str, float], windows: Windows
) -> Iterator[Dict[str, np.ndarray]]:
    """Yield the predictions for each block of judged windows of a flight."""
    ends = windows.start + INSTANTS[-1]
    begin = _find_begin(windows)
    while begin <= windows.start[-1]:
        own = (windows.start >= begin) & (windows.start < begin + _BLOCK)
        if own.any():
            before = ends <= begin
            before = before if before.sum() >= _FEWEST else windows.start < begin
            recent = before & (ends > begin - _MEMORY)
            known = windows.choose(recent if recent.sum() >= _FEWEST else before)
            trims = calibrate_trims(Predictor(fitted, known), dict(values))
            yield Predictor(fitted, windows.choose(own)).predict([values], [trims])[0]
        begin += _BLOCK


def make_logs(judgement: Judgement) -> List[Tuple[str, Log]]:
    """Make logs of the measured and predicted states of the first flight, for an animation.

    The predicted states of a window are used until the next window begins.
    """
    windows = judgement.windows
    if "position" not in windows.states:
        return []
    own = windows.flight == 0
    within = [i for i, instant in enumerate(INSTANTS) if instant <= DECISIVE]
    time = (windows.start[own, None] + np.array(INSTANTS)[within]).ravel()
    new = np.diff(time, prepend=-np.inf) > 1e-6
    logs = []
    measured = {name: values[:, 1:] for name, values in windows.states.items()}
    for title, states in (("measured", measured), ("predicted", judgement.predicted)):
        parts: List[Any] = [(time - time[0])[:, None]]
        parts += [
            states[name][own][:, within].reshape(len(time), -1)
            for name in ("position", "orientation", "velocity", "rates")
        ]
        logs.append((title, Log(np.hstack(parts)[new], title=title)))
    return logs
