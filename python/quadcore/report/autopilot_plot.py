"""Plot of an autopilot in a flight: errors of its estimates, its mode, and whether it was armed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterator, Mapping, Tuple

import numpy as np

from ..support.rotation import unwrap_angles
from .plots import AXES, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..simulation.trajectory import Trajectory

_POSITION, _ANGLES = ("x", "y", "z"), ("roll", "pitch", "yaw")
_STATES = ("armed", "mode")
_BAND = 0.7  # height of a band
_OFF, _ON = "0.85", AXES[2]


def has_autopilot(log: Trajectory) -> bool:
    """Whether an autopilot flew, and the log has whether it was armed."""
    return _STATES[0] in log.topics.get("controller", {})


def draw_autopilot(log: Trajectory, title: str) -> Figure:
    """Draw the errors of the estimates over time, and the mode and arming as bands.

    Parameters
    ----------
    log
        Log of a flight for which `has_autopilot` holds.
    title
        Title of the figure.
    """
    known = log.topics["controller"]
    errors = [
        (names, unit, error)
        for names, unit, error in (
            (_POSITION, "m", _subtract(known, _POSITION, log.position)),
            (_ANGLES, "deg", _find_angles(known, log)),
        )
        if error is not None
    ]
    figure, grid = panels(title, len(errors) + 1)
    for axes, (names, unit, error) in zip(grid[:, 0], errors):
        for curve, colour, name in zip(error.T, AXES, names):
            axes.plot(log.time, curve, color=colour, label=name)
        axes.set_ylabel(f"estimate error ({unit})")
        axes.legend(loc="lower right", bbox_to_anchor=(1, 0.97), ncol=len(names), frameon=False)
    states = [name for name in _STATES if name in known]
    _draw_bands(grid[-1, 0], log.time, [(name, known[name]) for name in states])
    return figure


def _subtract(known: Mapping[str, Any], names: Tuple[str, ...], true: np.ndarray) -> Any:
    """Return estimate minus truth, (rows, 3), or None without an estimate."""
    columns = [f"estimate_{name}" for name in names]
    if not set(columns) <= set(known):
        return None
    return np.column_stack([known[name] for name in columns]) - true


def _find_angles(known: Mapping[str, Any], log: Trajectory) -> Any:
    error = _subtract(known, _ANGLES, unwrap_angles(log.rpy))
    return None if error is None else np.degrees(np.remainder(error + np.pi, 2 * np.pi) - np.pi)


def _draw_bands(axes: Any, time: np.ndarray, states: Any) -> None:
    for row, (name, values) in enumerate(states):
        for begin, end, value in _find_spans(time, np.asarray(values)):
            at = (row - _BAND / 2, _BAND)
            axes.broken_barh([(begin, end - begin)], at, color=_ON if value else _OFF)
            text = f"{name} {value:g}" if name == "mode" else name if value else f"not {name}"
            axes.text(begin, row, f" {text}", va="center", clip_on=True)
    axes.set_yticks(range(len(states)), [name for name, _ in states])
    axes.set_ylim(-0.5, len(states) - 0.5)


def _find_spans(time: np.ndarray, values: np.ndarray) -> Iterator[Tuple[float, float, float]]:
    """Yield begin, end and value of each span in which a value is known and constant."""
    rows = np.flatnonzero(np.isfinite(values))
    if not len(rows):
        return
    changes = 1 + np.flatnonzero(np.diff(values[rows]))
    for span in np.split(rows, changes):
        yield float(time[span[0]]), float(time[span[-1]]), float(values[span[0]])
