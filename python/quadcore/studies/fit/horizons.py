"""Short pieces of a flight, flown side by side from measured states."""

from __future__ import annotations

from typing import Any, Callable, Dict, List, Mapping, Sequence

import numpy as np

from ..._core import InputError, Rotor
from ...simulation.batch import BatchSimulation, BatchState
from .record import CHANNELS, Record

_FEW = 1024  # vehicles that one thread steps as fast as several
_SETTLED = 40
"""Steps that hinges of ODE take to give way as they do under load, which a state does not tell."""


class Horizons:
    """Pieces of a record, each of which begins in a state that was measured.

    Parameters
    ----------
    record
        The flight.
    make
        Keywords of `BatchSimulation` but for n and parameters.
    fixed
        Parameters that all fly with.
    dt
        Step, s.
    length
        Of a piece, s.
    channels
        Names of `CHANNELS` that are compared.
    rotors
        Of the vehicle. Without recorded commands, `_commands` computes them from measured speeds.
    part
        Called with the number of a piece: whether it is one of these.

    Attributes
    ----------
    count : int
        Of the pieces.
    width : int
        Numbers that are compared in each.
    corrections : int
        Numbers by which the start of each may be corrected: position, turn, velocity, rates, those
        of the rotors.
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
            raise InputError("the log is shorter than a horizon; make that shorter")
        pieces = self._split_pieces(steps, round(length / dt))
        starts = [piece for i, piece in enumerate(pieces) if part(i)]
        if not starts:
            raise InputError(f"the log has {len(pieces)} horizons, too few; make them shorter")
        skipped = 0 if make["engine"] == "eigen" else _SETTLED
        self._rows = [
            a + 1 + np.flatnonzero(steps[a + 1 : b + 1] - steps[a] > skipped) for a, b in starts
        ]
        most = int(np.median([len(rows) for rows in self._rows]))
        if most < 3:
            raise InputError("the log has too few rows within a horizon; make it longer")
        keep = [i for i, rows in enumerate(self._rows) if len(rows) >= most]
        self._rows = [self._rows[i][:most] for i in keep]
        self._first = first = np.array([starts[i][0] for i in keep])
        self.count = len(keep)
        self._offsets = np.array([steps[r] - steps[a] for r, a in zip(self._rows, first)])
        self._begin = steps[self._first]
        self._record = record
        self._commands, self._command_steps = _make_commands(record, dt, rotors)
        self._angles = _joint_angles(record)
        self.corrections = 12 + self.rotors
        sizes = {**CHANNELS, "rotors": self.rotors}
        self.sizes = [sizes[name] for name in self.channels]
        self.width = most * sum(self.sizes)
        self.shift = 0
        """Steps by which what was measured lags behind the commands."""

    def list_channels(self) -> np.ndarray:
        """Give the number of the channel of each number that is compared."""
        one = np.repeat(np.arange(len(self.sizes)), self.sizes)
        return np.tile(one, self.width // len(one))

    def fly(self, parameters: Sequence[Mapping[str, float]], starts: np.ndarray) -> np.ndarray:
        """Fly every piece with each set of parameters, from corrected starts.

        Parameters
        ----------
        parameters
            A mapping for each group.
        starts
            Corrections, shape (groups, count, corrections).

        Returns
        -------
        ndarray, shape (groups, count, width)
            Flown less measured, NaN where a flight failed.
        """
        groups, n = len(parameters), len(parameters) * self.count
        given: Dict[str, Any] = dict(self._fixed)
        for name in parameters[0]:
            given[name] = np.repeat([each[name] for each in parameters], self.count)
        threads = 1 if n < _FEW else None
        batch = BatchSimulation(n=n, parameters=given, dt=self._dt, threads=threads, **self._make)
        batch.set_state(self._make_states(starts.reshape(n, self.corrections), groups))
        rows = np.array(self._rows)
        state = np.empty((n, batch.state_width))
        states = np.empty((groups, *rows.shape, batch.state_width))
        begin, flown = np.tile(self._begin, groups), 0
        changes = self._list_command_steps(int(self._offsets.max()))
        for stop in sorted({*np.unique(self._offsets).tolist(), *changes}):
            if flown in changes:
                batch.step(self._find_command(begin + flown), 0)
            batch.step(None, stop - flown)
            flown = stop
            piece, row = np.nonzero(self._offsets == stop)
            if len(piece):
                batch.read_state(state)
                states[:, piece, row] = state.reshape(groups, self.count, -1)[:, piece]
        compared = self._compare(
            BatchState.of(states.reshape(-1, batch.state_width)), np.tile(rows.ravel(), groups)
        )
        compared = compared.reshape(n, self.width)
        compared[batch.failed] = np.nan
        return compared.reshape(groups, self.count, self.width)

    def _split_pieces(self, steps: np.ndarray, length: int) -> List[Any]:
        """Rows in which pieces begin and end."""
        if length < 1:
            raise InputError("a horizon is shorter than a step; make it longer")
        found, first = [], 0
        while steps[-1] >= steps[first] + length:
            last = int(np.searchsorted(steps, steps[first] + length, "right")) - 1
            if last > first:
                found.append((first, last))
            first = max(last, first + 1)  # a gap of the log may be longer than a horizon
        return found

    def _list_command_steps(self, end: int) -> List[int]:
        """Find the steps of a piece, 0 and later, with which some command changes."""
        since = (self._command_steps[None, :] + self.shift) - self._begin[:, None]
        inside = since[(since > 0) & (since < end)]
        return [0, *np.unique(inside).tolist()]

    def _find_command(self, steps: np.ndarray) -> np.ndarray:
        row = np.searchsorted(self._command_steps, steps - self.shift, "right") - 1
        commands: np.ndarray = self._commands[np.maximum(row, 0)]
        return commands

    def _make_states(self, corrections: np.ndarray, groups: int) -> np.ndarray:
        r, rows = self._record, np.tile(self._first, groups)
        turn = corrections[:, 3:6] - r.rates[rows] * self._late[rows, None]
        moved = corrections[:, :3] - r.velocity[rows] * self._late[rows, None]
        return np.hstack(
            [
                r.position[rows] + moved,
                _turn(r.orientation[rows], turn),
                r.velocity[rows] + corrections[:, 6:9],
                r.rates[rows] + corrections[:, 9:12],
                r.rotors[rows] + corrections[:, 12:],
                self._angles[rows],
            ]
        )

    def _compare(self, state: BatchState, rows: np.ndarray) -> np.ndarray:
        """Flown less measured, of rows that may be a little off the grid of steps."""
        r, late = self._record, self._late[rows, None]
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


def _drop_close_rows(record: Record, dt: float) -> Record:
    """Leave out rows that lie closer than most do."""
    steps = np.rint((record.time - record.time[0]) / dt).astype(int)
    every = int(np.median(np.diff(steps)))
    kept = [0]
    for row, step in enumerate(steps):
        if step - steps[kept[-1]] >= max(1, 0.9 * every):
            kept.append(row)
    parts = {name: part[kept] for name, part in record._asdict().items() if name != "commands"}
    return Record(**parts, commands=record.commands)


def _make_commands(record: Record, dt: float, rotors: Sequence[Rotor]) -> Any:
    """Return commands and the steps with which they begin.

    Without recorded commands, they are those with which the motors follow the measured speeds w:
    from tau dw/dt = r c - w, c = (w + tau dw/dt) / r, r being the `Rotor.rate_per_command`.
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
    """Angles of the joints, 0 in the first row; (-pi, pi]."""
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
    """Turn by a small angle about the body's axes, rad."""
    half = turn / 2
    small = np.hstack([half, np.ones((len(q), 1))])
    turned = _multiply(q, small / np.linalg.norm(small, axis=1, keepdims=True))
    return turned


def _turn_between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Small turn from a to b in a's axes, rad."""
    inverse = a * np.array([-1, -1, -1, 1])
    apart = _multiply(inverse, b)
    turn: np.ndarray = 2 * np.sign(apart[:, 3:]) * apart[:, :3]
    return turn
