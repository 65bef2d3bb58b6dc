"""Judgement of a model by its predictions of flights that it was not fitted to."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

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
"""First part of a flight, from which its trims come; the rest is judged."""
DECISIVE = 0.25
"""Horizon at which a model must be better than the baselines, s."""
_COMPARED = {True: ("position", "attitude"), False: ("rates",)}


class Judgement(NamedTuple):
    """Errors of predictions over the horizon.

    Attributes
    ----------
    errors : dict of str to dict of str to ndarray (instants,)
        RMS error of each model and baseline, by channel, in the units of `CHANNELS`.
    windows : Windows
        Judged windows.
    trims : dict of str to ndarray (flights, trims)
        Delay, factor of the speeds, and constant torques of each flight, by model.
    predicted : dict of str to ndarray
        States that the first model predicts.
    """

    errors: Dict[str, Dict[str, np.ndarray]]
    windows: Windows
    trims: Dict[str, np.ndarray]
    predicted: Dict[str, np.ndarray]

    def list_rows(self) -> List[Tuple[str, str, str, List[float]]]:
        """List model, channel, unit, and the errors at `HORIZONS`."""
        places = [INSTANTS.index(horizon) for horizon in HORIZONS]
        return [
            (model, channel, CHANNELS[channel], [float(values[i]) for i in places])
            for model, of_channels in self.errors.items()
            for channel, values in of_channels.items()
        ]

    def check(self) -> None:
        """Raise `FlightError` if the first model is worse than another row at 0.25 s."""
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
    """Predict flights with models and with a baseline.

    The first 30 % of each flight give its delay, its factor of the rotor speeds and its constant
    torque, which depend on battery and trim. The rest is judged.

    Parameters
    ----------
    models
        Models with their values of free parameters and inputs, by name. The first is judged.
    flights
        Prepared flights.
    """
    windows = make_windows(flights)
    early = np.zeros(len(windows.start), bool)
    for number in range(len(windows.flights)):
        own = windows.flight == number
        start = windows.start[own]
        early[own] = start < start[0] + _CALIBRATED * (start[-1] - start[0])
    judged = windows.choose(~early)
    errors: Dict[str, Dict[str, np.ndarray]] = {}
    trims: Dict[str, np.ndarray] = {}
    first: Optional[Dict[str, np.ndarray]] = None
    for name, (fitted, values) in models.items():
        trims[name] = calibrate_trims(Predictor(fitted, windows.choose(early)), dict(values))
        [predicted] = Predictor(fitted, judged).predict([values], [trims[name]])
        errors[name] = compute_rms(compute_errors(judged, predicted))
        first = predicted if first is None else first
    errors[CONSTANT] = compute_rms(compute_errors(judged, predict_constant(judged)))
    assert first is not None
    return Judgement(errors, judged, trims, first)


def make_logs(judgement: Judgement) -> List[Tuple[str, Log]]:
    """Make the logs of measured and predicted states of the first flight, for an animation.

    The predicted states of a window end where the next window begins.
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
