"""Fit of model parameters to a flight."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from ..._core import FlightError, InputError, Model
from ...simulation.engines import STUDY_ENGINE, EngineName
from ...simulation.log import Log
from ...support import arguments
from ...support.warning import suppress_warnings
from . import record as records
from .coordinates import check_bodies
from .fitted_model import FittedModel
from .horizons import Horizons
from .identifiability import Combination, Identifiability, analyse
from .motion import FITTED, MEASURED, START, compute_motion, join_motion
from .problem import Problem, check_free_names, make_parameter
from .search import search

Progress = Callable[[int, int], None]

_KINDS = {
    "log": ((lambda log: isinstance(log, (Log, str, Path))), "a log, or its file"),
    "free": arguments.NAMES,
    "engine": arguments.NAME,
    "horizon": arguments.POSITIVE,
    "channels": arguments.or_none(arguments.NAMES),
    "sensed": arguments.or_none(arguments.NAME),
    "bounds": arguments.or_none(arguments.BOUNDS),
    "shift": arguments.LAG,
    "progress": arguments.or_none(arguments.PROGRESS),
}

_HELD_OUT = 4  # every 4th horizon is held out


class Fit(NamedTuple):
    """Result of a fit.

    Attributes
    ----------
    values : dict of str to float
        Value of each free parameter; it stays near the start value if it is not identifiable.
    start, units : dict
        Start value and unit of each parameter.
    identified : Identifiability
        Standard deviations, covariance and identifiable combinations.
    shift : float
        Lag of the measurements relative to the commands, s.
    train : dict of str to pair of float
        RMS residual of each channel with the start values and with the fitted values, in the unit
        of the channel. The initial states of the horizons are fitted in both cases.
    held_out : dict of str to pair of float
        RMS residuals of the held-out horizons, as in `train`.
    model : Model
        Model with the fitted values.
    motion : list of (str, Log)
        Measured motion, and motion of the fitted and the initial model; each horizon starts from a
        measured state. Empty unless the channels contain position and attitude.
    """

    values: Dict[str, float]
    start: Dict[str, float]
    units: Dict[str, str]
    identified: Identifiability
    shift: float
    train: Dict[str, Tuple[float, float]]
    held_out: Dict[str, Tuple[float, float]]
    model: Model
    motion: List[Tuple[str, Log]]

    @property
    def combinations(self) -> List[Combination]:
        """Identifiable sums of parameters that are not identifiable individually."""
        return self.identified.combinations

    def __repr__(self) -> str:
        deviations = self.identified.deviations
        found = (f"{name} = {v:.6g} +- {deviations[name]:.2g}" for name, v in self.values.items())
        return f"<Fit: {', '.join(found)}>"

    def describe(self) -> List[str]:
        """Describe the identifiability of the parameters, one statement per line."""
        lines = [
            f"only the sum is identifiable: {each} = {each.value:.6g} +- {each.deviation:.2g}"
            for each in self.combinations
        ]
        lines += [f"no effect on this flight: {n}" for n in self.identified.without_effect]
        if self.shift:
            lines.append(f"lag of the measurements behind the commands: {self.shift:g} s")
        values = ", ".join(f"{value:.2g}" for value in self.identified.singular_values)
        return [*lines, f"singular values of the unit derivatives: {values}"]

    def list_residuals(self) -> List[Tuple[str, str, List[float]]]:
        """List the channel, unit and RMS residuals of each channel.

        The residuals are those of the start values, of the fitted values, and of the fitted values
        on the held-out horizons (NaN without any).
        """
        nan = float("nan")
        return [
            (name, records.UNITS[name], [*train, self.held_out.get(name, (nan, nan))[1]])
            for name, train in self.train.items()
        ]


def fit(
    model: Union[str, Path, Model],
    log: Union[Log, str, Path],
    free: Sequence[str],
    commands: Union[np.ndarray, str, Path, None] = None,
    engine: EngineName = STUDY_ENGINE,
    horizon: float = 1.0,
    channels: Optional[Sequence[str]] = None,
    sensed: Optional[str] = None,
    bounds: Optional[Mapping[str, Tuple[float, float]]] = None,
    shift: float = 0.0,
    parameters: Optional[Mapping[str, Any]] = None,
    world: Any = None,
    dt: Optional[float] = None,
    xacro_args: Optional[Mapping[str, object]] = None,
    ignore: Sequence[str] = (),
    progress: Optional[Progress] = None,
) -> Fit:
    """Fit parameters of a model to a flight log.

    The log is split into horizons. A `BatchSimulation` simulates each horizon from its first row.
    SciPy's ``least_squares`` minimises the residuals, weighted by their estimated noise.

    Parameters
    ----------
    model, engine, world, dt, xacro_args, ignore
        As for `Simulation`.
    log
        Log or log file with pose, velocities and rotor speeds.
    free
        Names of the free parameters: ``PLUGIN.TAG``, ``LINK.mass``, ``LINK.ixx`` or ``xacro.ARG``.
    commands
        Commands as for `Simulation.run` (default: topic ``vel_cmd`` of the log, else computed from
        the measured rotor speeds).
    horizon
        Length of a horizon, s.
    channels
        Channels to compare: some of "position", "attitude", "velocity", "rates" and "rotors"
        (default: all but "velocity").
    sensed
        Topic of the log with measured pose and velocities (default: the state).
    bounds
        Minimum and maximum value by parameter name (default: non-negative parameters stay
        non-negative).
    shift
        Maximum lag of the measurements relative to the commands, s; the lag is fitted.
    parameters
        As for `Simulation`: fixed values, and start values of the free parameters.
    progress
        Function called as progress(done, total).

    Returns
    -------
    Fit
        Fitted values, their identifiability, and the model with these values.

    Raises
    ------
    InputError
        If an argument is invalid.
    FlightError
        If flights that start from measured states fail.
    KeyboardInterrupt
        On Ctrl-C. The attribute `model` is the model with the values of the last round.
    """
    arguments_given = dict(locals())
    options = ("parameters", "world", "dt", "xacro_args", "ignore")
    arguments.check({name: arguments_given[name] for name in (*_KINDS, *options)}, _KINDS)
    named = check_free_names(free)
    fitted = FittedModel(named, model, engine, world, dt, parameters, xacro_args, ignore)
    simulation = fitted.simulation
    known = dict(bounds or {})
    for name in known:
        if name not in named:
            raise InputError(
                f"bound {name}: the parameter is not free. Free it, or remove the bound."
            )
    wanted = [make_parameter(name, fitted, known.get(name)) for name in named]
    flown = records.read_record(log, simulation.rotor_count, commands, sensed)
    names = records.choose_channels(channels, flown)
    rotors = simulation.rotors

    def problem(is_held_out: bool) -> Problem:
        pieces = Horizons(
            flown, fitted.make, fitted.fixed, simulation.dt, horizon, names, rotors,
            lambda i: (i % _HELD_OUT == _HELD_OUT - 1) == is_held_out,
        )  # fmt: skip
        return Problem(pieces, wanted)

    with suppress_warnings():
        train = problem(False)
        train.horizons.shift = _find_shift(train, round(shift / simulation.dt))
        try:
            found = search(train, progress=progress)
        except KeyboardInterrupt as stop:
            best = dict(zip([p.name for p in wanted], stop.values.tolist()))  # type: ignore[attr-defined]
            stop.model = fitted.make_model(best)  # type: ignore[attr-defined]
            raise
        return _make_fit(train, problem, found, fitted)


def _make_fit(
    train: Problem, problem: Callable[[bool], Problem], found: np.ndarray, fitted: FittedModel
) -> Fit:
    wanted = train.parameters
    names = [p.name for p in wanted]
    train.linearise_starts(found)
    left = train.compute_residuals(found)
    freedom = len(left) - train.starts.size - len(found)
    identified = analyse(
        names,
        found,
        np.array([p.size for p in wanted]),
        train.compute_derivative(found),
        left,
        freedom,
    )
    start = np.array([p.start for p in wanted])
    residuals: List[Dict[str, Tuple[float, float]]] = []
    motion: List[Dict[str, np.ndarray]] = []
    for is_held_out in (False, True):
        try:
            judged = problem(is_held_out)
        except InputError:  # too few horizons
            residuals.append({})
            continue
        judged.horizons.shift = train.horizons.shift
        each, simulated = [], {}
        for name, tried in ((START, start), (FITTED, found)):
            judged.starts[:] = 0
            judged.noise = train.noise.copy()
            each.append(_compute_rms(judged, tried))
            simulated.update(compute_motion(judged, {name: tried}))
        residuals.append({name: (each[0][name], each[1][name]) for name in each[0]})
        motion.append({name: simulated[name] for name in (MEASURED, FITTED, START) if simulated})
    values = dict(zip(names, found.tolist()))
    fitted_model = fitted.make_model(values)
    check_bodies(fitted_model, values)
    return Fit(
        values,
        dict(zip(names, start.tolist())),
        {p.name: p.unit for p in wanted},
        identified,
        train.horizons.shift * fitted.simulation.dt,
        residuals[0],
        residuals[1],
        fitted_model,
        join_motion(motion),
    )


def _compute_rms(problem: Problem, values: np.ndarray) -> Dict[str, float]:
    """Compute the RMS residual of each channel, with fitted starts; infinite if a flight fails."""
    try:
        problem.linearise_starts(values)
        problem.correct_starts(values)
        problem.linearise_starts(values)
    except FlightError:
        return dict.fromkeys(problem.horizons.channels, np.inf)
    return problem.compute_rms(values)


def _find_shift(problem: Problem, most: int) -> int:
    """Find the lag in steps by a coarse-to-fine search, with a short fit for each lag."""
    costs: Dict[int, float] = {}

    def cost(steps: int) -> float:
        if steps not in costs:
            problem.horizons.shift = steps
            problem.starts[:] = 0
            problem.noise[:] = 1
            values = search(problem, rounds=2)
            problem.linearise_starts(values)
            costs[steps] = float(np.sum(np.log(problem.noise)))
        return costs[steps]

    if most <= 0:
        return 0
    best, reach = 0, 1 << (most.bit_length() - 1)
    while reach:
        near = [steps for steps in (best - reach, best, best + reach) if abs(steps) <= most]
        best = min(near, key=cost)
        reach //= 2
    problem.starts[:] = 0
    problem.noise[:] = 1
    return best
