"""Horizons: short pieces of a flight, simulated in parallel from measured states."""

from __future__ import annotations

from typing import Any, Callable, Dict, List, Mapping, Sequence

import numpy as np

from ..._core import InputError, Rotor
from ...simulation.batch import BatchSimulation, BatchState
from .record import CHANNELS, Record

_FEW = 1024  # up to this number of vehicles, one thread is as fast as several threads
_SETTLED = 40
"""Steps until the hinges of ODE settle under load; a state does not contain their deflection."""


class Horizons:
    """Pieces of a record, each simulated from a measured state.

    Parameters
    ----------
    record
        Record of the flight.
    make
        Keyword arguments of `BatchSimulation` except n and parameters.
    fixed
        Parameters that are equal for all horizons.
    dt
        Step, s.
    length
        Length of a horizon, s.
    channels
        Names of the `CHANNELS` to compare.
    rotors
        Rotors of the vehicle. `_make_commands` uses them to compute missing commands.
    part
        Function called with the number of a piece; returns whether to use the piece.

    Attributes
    ----------
    record : Record
        Record without rows that are too close to the previous row.
    rows : ndarray (count, rows)
        Rows of the record that each piece compares.
    count : int
        Number of pieces.
    width : int
        Number of compared values per piece.
    corrections : int
        Number of corrections of each initial state: position, rotation, velocity, rates, and the
        rotor speeds if they are compared.
    """

    def __init__(
        self,
        record: Record,
        make: Mapping[str, Any],
        fixed: Mapping[str, Any],
        dt: float,
        length: float,
        channels: Sequence[str],
        rotors: Sequence[Rotor],
        part: Callable[[int], bool],
    ) -> None:
        self._make, self._fixed, self._dt = make, fixed, dt
        self.channels = list(channels)
        self.rotors = record.rotors.shape[1]
        record = _drop_close_rows(record, dt)
        steps = np.rint((record.time - record.time[0]) / dt).astype(int)
        self._late = record.time - record.time[0] - steps * dt
        if length > record.time[-1] - record.time[0]:
            raise InputError("the log is shorter than a horizon. Give a shorter horizon.")
        pieces = self._split_pieces(steps, round(length / dt))
        starts = [piece for i, piece in enumerate(pieces) if part(i)]
        if not starts:
            raise InputError(f"the log has only {len(pieces)} horizons. Give a shorter horizon.")
        skipped = 0 if make["engine"] == "eigen" else _SETTLED
        rows = [
            a + 1 + np.flatnonzero(steps[a + 1 : b + 1] - steps[a] > skipped) for a, b in starts
        ]
        most = int(np.median([len(each) for each in rows]))
        if most < 3:
            raise InputError("the log has too few rows per horizon. Give a longer horizon.")
        keep = [i for i, each in enumerate(rows) if len(each) >= most]
        self.rows = np.array([rows[i][:most] for i in keep])
        self._first = first = np.array([starts[i][0] for i in keep])
        self.count = len(keep)
        offsets = np.array([steps[r] - steps[a] for r, a in zip(self.rows, first)])
        self._compared = _group_by_step(offsets)
        self._begin = steps[self._first]
        self.record = record
        self._commands, self._command_steps = _make_commands(record, dt, rotors)
        self._angles = _joint_angles(record)
        self.corrections = 12 + self.rotors * ("rotors" in self.channels)
        sizes = {**CHANNELS, "rotors": self.rotors}
        self.sizes = [sizes[name] for name in self.channels]
        self.width = most * sum(self.sizes)
        self.shift = 0
        """Lag of the measurements relative to the commands, in steps."""

    def list_channels(self) -> np.ndarray:
        """Return the channel index of each compared value of a piece."""
        one = np.repeat(np.arange(len(self.sizes)), self.sizes)
        return np.tile(one, self.width // len(one))

    def fly(self, parameters: Sequence[Mapping[str, float]], starts: np.ndarray) -> np.ndarray:
        """Simulate every piece with each set of parameters, from corrected initial states.

        Parameters
        ----------
        parameters
            Parameter values by name, for each set.
        starts
            Corrections of the initial states, shape (sets, count, corrections).

        Returns
        -------
        ndarray, shape (groups, count, width)
            Simulated minus measured values; NaN after a failure.
        """
        groups, n = len(parameters), len(parameters) * self.count
        given: Dict[str, Any] = dict(self._fixed)
        for name in parameters[0]:
            given[name] = np.repeat([each[name] for each in parameters], self.count)
        threads = 1 if n < _FEW else None
        batch = BatchSimulation(n=n, parameters=given, dt=self._dt, threads=threads, **self._make)
        batch.set_state(self._make_states(starts.reshape(n, self.corrections), groups))
        rows = self.rows
        state = np.empty((n, batch.state_width))
        states = np.empty((groups, *rows.shape, batch.state_width))
        changes = self._find_commands(max(self._compared))
        stops = sorted({*self._compared, *changes})
        for start, stop in zip(stops, stops[1:]):
            change = changes.get(start)
            commands = None if change is None else self._commands[np.tile(change, groups)]
            batch.step(commands, stop - start)
            if stop in self._compared:
                piece, row = self._compared[stop]
                batch.read_state(state)
                states[:, piece, row] = state.reshape(groups, self.count, -1)[:, piece]
        compared = self._compare(
            BatchState.of(states.reshape(-1, batch.state_width)), np.tile(rows.ravel(), groups)
        )
        compared = compared.reshape(n, self.width)
        compared[batch.failed] = np.nan
        return compared.reshape(groups, self.count, self.width)

    def _split_pieces(self, steps: np.ndarray, length: int) -> List[Any]:
        """Return the first and last row of each piece."""
        if length < 1:
            raise InputError("the horizon is shorter than a step. Give a longer horizon.")
        found, first = [], 0
        while steps[-1] >= steps[first] + length:
            last = int(np.searchsorted(steps, steps[first] + length, "right")) - 1
            if last > first:
                found.append((first, last))
            first = max(last, first + 1)  # a gap may be longer than a horizon
        return found

    def _find_commands(self, end: int) -> Dict[int, np.ndarray]:
        """Return the command row of each piece, by the steps at which the commands change."""
        since = (self._command_steps[None, :] + self.shift) - self._begin[:, None]
        inside = since[(since > 0) & (since < end)]
        steps = np.array([0, *np.unique(inside)])
        at = steps[:, None] + self._begin[None, :] - self.shift
        rows = np.maximum(np.searchsorted(self._command_steps, at, "right") - 1, 0)
        return dict(zip(steps.tolist(), rows))

    def _make_states(self, corrections: np.ndarray, groups: int) -> np.ndarray:
        r, rows = self.record, np.tile(self._first, groups)
        turn = corrections[:, 3:6] - r.rates[rows] * self._late[rows, None]
        moved = corrections[:, :3] - r.velocity[rows] * self._late[rows, None]
        speeds = r.rotors[rows]
        speeds[:, : corrections.shape[1] - 12] += corrections[:, 12:]
        return np.hstack(
            [
                r.position[rows] + moved,
                _turn(r.orientation[rows], turn),
                r.velocity[rows] + corrections[:, 6:9],
                r.rates[rows] + corrections[:, 9:12],
                speeds,
                self._angles[rows],
            ]
        )

    def _compare(self, state: BatchState, rows: np.ndarray) -> np.ndarray:
        """Return simulated minus measured values; the rows may lie between steps."""
        r, late = self.record, self._late[rows, None]
        parts: Dict[str, Callable[[], np.ndarray]] = {
            "position": lambda: state.position + late * state.linear_velocity - r.position[rows],
            "attitude": lambda: _turn_between(
                r.orientation[rows], _turn(state.orientation, late * state.angular_velocity)
            ),
            "velocity": lambda: state.linear_velocity - r.velocity[rows],
            "rates": lambda: state.angular_velocity - r.rates[rows],
            "rotors": lambda: state.rotor_velocity - r.rotors[rows],
        }
        return np.hstack([parts[name]() for name in self.channels])


def _group_by_step(offsets: np.ndarray) -> Dict[int, Any]:
    """Group the indices of the entries by value."""
    order = np.argsort(offsets, axis=None, kind="stable")
    values, first = np.unique(offsets.ravel()[order], return_index=True)
    groups = np.split(order, first[1:])
    return {
        int(value): np.unravel_index(group, offsets.shape) for value, group in zip(values, groups)
    }


def _drop_close_rows(record: Record, dt: float) -> Record:
    """Drop rows that are too close to the previous row."""
    steps = np.rint((record.time - record.time[0]) / dt).astype(int)
    every = int(np.median(np.diff(steps)))
    kept = [0]
    for row, step in enumerate(steps):
        if step - steps[kept[-1]] >= max(1, 0.9 * every):
            kept.append(row)
    parts = {name: part[kept] for name, part in record._asdict().items() if name != "commands"}
    return Record(**parts, commands=record.commands)


def _make_commands(record: Record, dt: float, rotors: Sequence[Rotor]) -> Any:
    """Return the commands, and the steps at which they become valid.

    Missing commands c are computed from the measured speeds w and the motor model tau dw/dt = r c -
    w with r = `Rotor.rate_per_command`: c = (w + tau dw/dt) / r.
    """
    start = record.time[0]
    if record.commands is not None:
        table = record.commands
        steps = np.ceil((table[:, 0] - start) / dt - 1e-6).astype(int)
        return np.ascontiguousarray(table[:, 1:]), steps
    speeds = record.rotors
    lags = np.nan_to_num([rotor.time_constant for rotor in rotors])
    per_rate = [1 / (rotor.rate_per_command or 1.0) for rotor in rotors]
    lead = per_rate * (speeds + lags * np.gradient(speeds, record.time, axis=0))
    column = {rotor.command_index: i for i, rotor in enumerate(rotors)}
    order = [column[k] for k in sorted(k for k in column if k is not None)] or slice(None)
    middle = ((lead[1:] + lead[:-1]) / 2)[:, order]
    return np.ascontiguousarray(middle), np.rint((record.time[:-1] - start) / dt).astype(int)


def _joint_angles(record: Record) -> np.ndarray:
    """Return the joint angles in (-pi, pi], rad; they are 0 in the first row."""
    mean = (record.rotors[1:] + record.rotors[:-1]) / 2
    turned = np.cumsum(mean * np.diff(record.time)[:, None], axis=0)
    angles: np.ndarray = np.vstack([np.zeros(record.rotors.shape[1]), turned])
    return np.pi - np.remainder(np.pi - angles, 2 * np.pi)


def _multiply(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Multiply quaternions x, y, z, w."""
    vector = a[:, 3:] * b[:, :3] + b[:, 3:] * a[:, :3] + np.cross(a[:, :3], b[:, :3])
    scalar = a[:, 3:] * b[:, 3:] - np.sum(a[:, :3] * b[:, :3], axis=1, keepdims=True)
    return np.hstack([vector, scalar])


def _turn(q: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Rotate quaternions by small angles about the body axes, rad."""
    half = turn / 2
    small = np.hstack([half, np.ones((len(q), 1))])
    turned = _multiply(q, small / np.linalg.norm(small, axis=1, keepdims=True))
    return turned


def _turn_between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the small rotation from a to b in the axes of a, rad."""
    inverse = a * np.array([-1, -1, -1, 1])
    apart = _multiply(inverse, b)
    turn: np.ndarray = 2 * np.sign(apart[:, 3:]) * apart[:, :3]
    return turn
