"""Predictions of real flights with a model on a batch."""

from __future__ import annotations

import re
from typing import Any, Dict, List, Mapping, Optional, Sequence

import numpy as np

from ... import _core
from ..._core import Document, Model
from ...simulation.batch import BatchSimulation, BatchState
from ...simulation.simulation import Simulation
from .fitted_model import FittedModel
from .inputs import INPUTS, TICK, demand_speeds, lag_speeds, lead_speeds
from .windows import INSTANTS, Windows

_TURN = 2.0
"""Maximum rotor angle per step, rad. Beyond half a turn, a batch steps vehicles one by one."""

_SENSORS = ("odometry", "imu", "gps", "barometer", "magnetometer")
"""Parts of the file names of sensor plugins, which do not affect the motion."""

DELAY, SPEED = "delay", "speed"
TORQUES = ("constantTorqueX", "constantTorqueY", "constantTorqueZ")
_FEW = 1024


class Predictor:
    """Model that predicts the windows of flights.

    Parameters
    ----------
    fitted
        Model with fixed values; its simulation defines the rotors.
    windows
        Windows to predict.

    Attributes
    ----------
    trim : list of str
        Parameters that differ between flights: ``delay`` (s), ``speed`` (a factor on the rotor
        speeds that commands demand), and the constant torques (N m) if the model has them.
    """

    def __init__(self, fitted: FittedModel, windows: Windows) -> None:
        self.fitted, self.windows = fitted, windows
        self.rotors = fitted.simulation.rotors
        self._torques = _find_torques(fitted)
        self._make = {**fitted.make, "engine": "eigen"}
        if isinstance(self._make["model"], Model):
            self._make["model"] = _remove_sensors(self._make["model"])
        fastest = max(rotor.max_speed for rotor in self.rotors)
        fastest = fastest if np.isfinite(fastest) else 3000.0
        self._steps = max(1, int(np.ceil(TICK * fastest / _TURN)))
        self.trim: List[str] = [DELAY, SPEED, *self._torques]

    def predict(
        self, values: Sequence[Mapping[str, float]], trims: Sequence[np.ndarray]
    ) -> List[Dict[str, np.ndarray]]:
        """Predict the states at `INSTANTS` for each set of values.

        Parameters
        ----------
        values
            Values of model parameters and of `INPUTS`, for each set.
        trims
            For each set, the values of `trim` of each flight, shape (flights, trims).

        Returns
        -------
        list of dict
            For each set, states by name, shape (n, instants, k); infinite if the flight fails.
        """
        windows, sets, n = self.windows, len(values), len(self.windows.start)
        total = sets * n
        given: Dict[str, Any] = dict(self.fitted.fixed)
        for name in values[0]:
            if name not in INPUTS:
                given[name] = np.repeat([each[name] for each in values], n)
        for k, name in enumerate(self._torques):
            given[name] = np.concatenate([trim[windows.flight, 2 + k] for trim in trims])
        threads = 1 if total < _FEW else None
        batch = BatchSimulation(
            n=total, parameters=given, dt=TICK / self._steps, threads=threads, **self._make
        )
        speeds = np.empty((total, round(INSTANTS[-1] / TICK), len(self.rotors)))
        first = np.empty((total, len(self.rotors)))
        for s, (each, trim) in enumerate(zip(values, trims)):
            part = slice(s * n, (s + 1) * n)
            self._fill_speeds(each, trim, speeds[part], first[part])
        batch.set_state(self._make_states(first, sets))
        order = np.argsort([rotor.command_index or 0 for rotor in self.rotors])
        commands = np.ascontiguousarray((speeds * [r.spin for r in self.rotors])[:, :, order])
        found = np.empty((total, len(INSTANTS), batch.state_width))
        at = {round(instant / TICK): i for i, instant in enumerate(INSTANTS)}
        for step in range(commands.shape[1]):
            batch.step(commands[:, step], self._steps)
            if step + 1 in at:
                found[:, at[step + 1]] = batch.read_state()
        found[batch.failed] = np.inf
        return [self._name(found[s * n : (s + 1) * n]) for s in range(sets)]

    def _fill_speeds(
        self, values: Mapping[str, float], trim: np.ndarray, speeds: np.ndarray, first: np.ndarray
    ) -> None:
        constants = self._find_time_constants(values)
        steps = (np.arange(speeds.shape[1]) + 0.5) * TICK
        for number, flight in enumerate(self.windows.flights):
            own = self.windows.flight == number
            start = self.windows.start[own] - trim[number, 0]
            if flight.rotors is not None:
                speeds[own] = lead_speeds(flight, start, speeds.shape[1], constants)
                first[own] = demand_speeds(flight, start, values, len(self.rotors))
                continue
            factor = trim[number, 1]
            speeds[own] = factor * demand_speeds(
                flight, start[:, None] + steps, values, len(self.rotors)
            )
            first[own] = factor * lag_speeds(flight, start, values, constants)

    def _find_time_constants(self, values: Mapping[str, float]) -> np.ndarray:
        tags = {n: v for n, v in values.items() if n in self._of_motors}
        if not tags:
            return np.array([rotor.time_constant for rotor in self.rotors])
        simulation = Simulation(
            self.fitted.model, engine="eigen", parameters={**self.fitted.fixed, **tags}
        )
        return np.array([rotor.time_constant for rotor in simulation.rotors])

    @property
    def _of_motors(self) -> List[str]:
        aerodynamic = {name.rpartition(".")[0] for name in self._torques}
        return [
            f"{plugin.name}.{tag.name}"
            for plugin in self.fitted.simulation.plugins
            for tag in plugin.parameters
            if plugin.name not in aerodynamic
        ]

    def _make_states(self, first: np.ndarray, sets: int) -> np.ndarray:
        begin = {name: values[:, 0] for name, values in self.windows.states.items()}
        n = len(self.windows.start)
        position = begin.get("position", np.zeros((n, 3)))
        orientation = begin.get("orientation", np.tile([0.0, 0, 0, 1], (n, 1)))
        velocity = begin.get("velocity", np.zeros((n, 3)))
        state = np.hstack([position, orientation, velocity, begin["rates"]])
        turning = first * [rotor.spin * abs(rotor.rate_per_command or 1) for rotor in self.rotors]
        return np.hstack([np.tile(state, (sets, 1)), turning, np.zeros_like(turning)])

    def _name(self, rows: np.ndarray) -> Dict[str, np.ndarray]:
        state = BatchState.of(rows.reshape(-1, rows.shape[2]))
        shape = rows.shape[:2]
        named = {"rates": state.angular_velocity.reshape(*shape, 3)}
        if "position" in self.windows.states:
            q = np.where(np.isfinite(state.orientation), state.orientation, 0.5)
            named.update(
                position=state.position.reshape(*shape, 3),
                velocity=state.linear_velocity.reshape(*shape, 3),
                orientation=q.reshape(*shape, 4),
            )
        return named


def _remove_sensors(model: Model) -> Model:
    """Remove sensor plugins, which would make a batch step vehicles one by one."""
    document = model.document
    text = document.text
    for plugin in re.findall(r"<plugin\b.*?(?:</plugin>|/>)", text, flags=re.DOTALL):
        name = re.search(r"filename\s*=\s*[\"']([^\"']*)", plugin)
        if name and any(sensor in name[1] for sensor in _SENSORS):
            text = text.replace(plugin, "\n" * plugin.count("\n"))
    return _core.read_model(
        Document(document.name, text, document.lines), list(model.ignored_elements.ignored)
    )


def _find_torques(fitted: FittedModel) -> List[str]:
    for plugin in fitted.simulation.plugins:
        tags = [tag.name for tag in plugin.parameters]
        if set(TORQUES) <= set(tags):
            return [f"{plugin.name}.{name}" for name in TORQUES]
    return []


def find_plugin(fitted: FittedModel, tag: str) -> Optional[str]:
    """Return the name of the first plugin with a tag, or None."""
    for plugin in fitted.simulation.plugins:
        if any(parameter.name == tag for parameter in plugin.parameters):
            return plugin.name
    return None
