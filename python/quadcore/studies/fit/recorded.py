"""Fits to recordings of real flights, and predictions of recordings."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

from ..._core import InputError, Model
from .coordinates import check_bodies
from .fitted_model import FittedModel
from .flight_fit import FlightFit, fit_flights
from .inputs import DELAY, INPUTS, MAP, guess_inputs, split_inputs
from .judgement import Judgement, judge_models
from .predictor import find_plugin
from .prepared import PreparedFlight, check_copies, prepare_flight
from .problem import check_free_names, make_parameter
from .replay import Replay, replay_flight
from .window_search import Progress

_TAGS = (
    "kp",
    "rotorTorqueCoeff",
    "inducedDragCoeff",
    "axialDragCoeff",
    "hubMomentCoeff",
    "rollDampingCoeff",
    "pitchDampingCoeff",
    "yawDampingCoeff",
)
"""Tags that are free by default if the model contains them and the recordings have a pose."""

_OF_RATES = ("kp", "rotorTorqueCoeff", "rollDampingCoeff", "pitchDampingCoeff", "yawDampingCoeff")
_MOMENTS = ("ixx", "iyy", "izz")
_GROUP = "inputs"

_MANOEUVRES = {
    "izz": "yaw turns that begin and end quickly",
    "ixx": "quick changes of the roll rate",
    "iyy": "quick changes of the pitch rate",
    "rotorTorqueCoeff": "yaw turns that begin and end quickly",
    "rotorThrustCoeff": "climbs",
    "mass": "a weighing of the vehicle, for flights show only ratios to the mass",
    "com_x": "quick climbs and descents, because its torque grows with the thrust",
    "com_y": "quick climbs and descents, because its torque grows with the thrust",
    "com_z": "fast horizontal flight in every direction, and quick turns",
    "axialDragCoeff": "quick climbs and descents",
    "bodyDragXCoeff": "different forward speeds",
    "bodyDragYCoeff": "different sideways speeds",
    "bodyDragZCoeff": "climbs at different speeds",
    "inducedDragCoeff": "fast horizontal flight in every direction",
    "hubMomentCoeff": "fast horizontal flight in every direction",
    "rollDampingCoeff": "flips or quick rolls",
    "pitchDampingCoeff": "flips or quick pitches",
    "yawDampingCoeff": "fast yaw turns",
    "kp": "steps of the commands",
    "exponent": "climbs and descents, so that commands differ",
    "battery": "a flight from a full to an empty battery",
    "speed": "hover",
}
"""Manoeuvre or measurement that identifies a parameter, by the last part of the name."""


class RecordedFit(NamedTuple):
    """Result of a fit to recordings.

    Attributes
    ----------
    found : FlightFit
        Fitted values and standard deviations.
    model : Model
        Fitted model.
    flights, judged : list of PreparedFlight
        Flights of the fit, and flights of the judgement.
    judgement : Judgement, optional
        Errors on the judged flights; None without such flights.
    """

    found: FlightFit
    model: Model
    flights: List[PreparedFlight]
    judged: List[PreparedFlight]
    judgement: Optional[Judgement]

    def describe(self) -> List[str]:
        """Describe the parameters that the flights do not identify, one per line."""
        lines = []
        for name, deviation in self.found.deviations.items():
            if not math.isnan(deviation):
                continue
            manoeuvre = _MANOEUVRES.get(name.rpartition(".")[2])
            hint = f" Fly {manoeuvre}." if manoeuvre else ""
            lines.append(f"{name}: these flights do not identify it.{hint}")
        return lines


def fit_recordings(
    model: Union[str, Path, Model],
    logs: Sequence[Union[str, Path]],
    judge: Sequence[Union[str, Path]] = (),
    free: Optional[Sequence[str]] = None,
    mapping: Optional[str] = None,
    bounds: Optional[Dict[str, Tuple[float, float]]] = None,
    parameters: Optional[Dict[str, Any]] = None,
    xacro_args: Optional[Dict[str, object]] = None,
    ignore: Sequence[str] = (),
    world: Any = None,
    progress: Optional[Progress] = None,
) -> RecordedFit:
    """Fit a model to recordings by the errors of its predictions.

    Parameters
    ----------
    model, xacro_args, ignore, world
        As for `fit`.
    parameters
        As for `fit`. Names in `INPUTS` are fixed at the given values unless they are free.
    logs
        Recordings to fit.
    judge
        Recordings on which the fitted and the initial model are judged.
    free
        Names of the free parameters; ``inputs`` stands for all of `INPUTS`. The delay is free
        unless `parameters` defines it. Default: the names of `list_default_names`.
    mapping
        Mapping of the recordings; see `read_recording`.
    bounds
        Minimum and maximum value by parameter name.
    progress
        Function called as progress(done, total).

    Raises
    ------
    InputError
        If an argument or a recording is invalid, or a judged recording is a copy of a fitted one.
    FlightError
        If predictions fail.
    """
    given, others = split_inputs(parameters)
    flights = [prepare_flight(log, mapping) for log in logs]
    judged = [prepare_flight(log, mapping) for log in judge]
    check_copies(flights, judged)

    def make(chosen: Sequence[str]) -> FittedModel:
        return FittedModel(chosen, model, "eigen", world, None, others, xacro_args, ignore)

    if free is None:
        names = [name for name in list_default_names(make([]), flights) if name not in given]
    else:
        names = _expand_group(check_free_names(free))
    of_inputs = [name for name in names if name in INPUTS]
    of_model = [name for name in names if name not in INPUTS]
    fitted = make(of_model)
    limits = dict(bounds or {})
    for name in limits:
        if name not in names or name == DELAY:
            raise InputError(
                f"bound {name}: the parameter is not free. Free it, or remove the bound."
            )
    wanted = [make_parameter(name, fitted, limits.pop(name, None)) for name in of_model]
    found = fit_flights(fitted, wanted, of_inputs, flights, given, limits, progress)
    values = {name: value for name, value in found.values.items() if name not in INPUTS}
    judgement = None
    if judged:
        models = {"fitted model": (fitted, found.values), "initial model": (fitted, found.start)}
        judgement = judge_models(models, judged)
    written = fitted.make_model(values)
    check_bodies(written, values)
    return RecordedFit(found, written, flights, judged, judgement)


def predict_recordings(
    model: Union[str, Path, Model],
    logs: Sequence[Union[str, Path]],
    inputs: Optional[Dict[str, float]] = None,
    mapping: Optional[str] = None,
    parameters: Optional[Dict[str, Any]] = None,
    xacro_args: Optional[Dict[str, object]] = None,
    ignore: Sequence[str] = (),
    world: Any = None,
    controller: Optional[str] = None,
) -> Tuple[Judgement, List[PreparedFlight], List[Replay]]:
    """Predict recordings with a model, and compare with constant velocity and rates.

    Parameters
    ----------
    inputs
        Values of `INPUTS` that `parameters` does not define (default: from the balance of thrust
        and weight).
    controller
        Controller for a closed-loop replay of the recorded set-points (default: no replay).
    model, logs, mapping, parameters, xacro_args, ignore, world
        As for `fit_recordings`.
    """
    given, others = split_inputs(parameters)
    flights = [prepare_flight(log, mapping) for log in logs]
    fitted = FittedModel([], model, "eigen", world, None, others, xacro_args, ignore)
    known = {**(inputs or {}), **given}
    weight = 9.81 * fitted.simulation.mass
    values = guess_inputs(flights, fitted.simulation.rotors, weight, known)
    replays = [replay_flight(fitted, flight, controller) for flight in flights if controller]
    return judge_models({"model": (fitted, values)}, flights), flights, replays


def list_default_names(fitted: FittedModel, flights: Sequence[PreparedFlight]) -> List[str]:
    """List the parameters that are free by default.

    These are inertia, motor lag, reaction torque, drag, hub moment and damping, if the model
    contains them. Without a pose, only parameters that act on the rates are free.
    """
    has_pose = all(flight.has_pose for flight in flights)
    names = []
    for tag in _TAGS if has_pose else _OF_RATES:
        plugin = find_plugin(fitted, tag)
        if plugin is not None:
            names.append(f"{plugin}.{tag}")
    link = fitted.model.links[0].name
    names += [f"{link}.{moment}" for moment in _MOMENTS]
    if any(flight.rotors is None for flight in flights):
        names += list(MAP) if has_pose else []
    return names


def _expand_group(names: Sequence[str]) -> List[str]:
    expanded: List[str] = []
    for name in names:
        expanded += list(INPUTS) if name == _GROUP else [name]
    return expanded
