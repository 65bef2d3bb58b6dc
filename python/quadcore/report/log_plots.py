"""Plots of one flight."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Sequence, Tuple

import numpy as np

from ..support.output_files import make_folder
from ..support.rotation import unwrap_angles
from .autopilot_plot import draw_autopilot, has_autopilot
from .colours import PALETTE
from .drawing import Drawing, save_drawings
from .plots import (
    AXES,
    NOTHING,
    REFERENCE,
    WHOLE,
    add_unslowed_axis,
    finish,
    flatten,
    make_figure,
    panels,
    space,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..simulation.trajectory import Trajectory

_NO_FORCE = 1e-9  # N, N m
_PLACES = ("x (m)", "y (m)", "z (m)")
_ANGLES = ("roll (deg)", "pitch (deg)", "yaw (deg)")


def draw(log: Trajectory, directory: Path, is_on_page: bool = True) -> dict[str, Drawing]:
    """Draw every plot of a flight into a folder, which is made if missing.

    Parameters
    ----------
    log
        Log of the flight.
    directory
        Folder of the files.
    is_on_page
        Whether a page will show the drawings.

    Returns
    -------
    dict of str to Drawing
        Drawings by name; their files are written.

    Raises
    ------
    InputError
        If the folder or a file cannot be written.
    """
    make_folder(directory)
    plots: dict[str, Callable[[Trajectory], Figure]] = {
        "position": _draw_position,
        "attitude": _draw_attitude,
        "rates": _draw_rates,
        "rotors": _draw_rotors,
        "wrenches": _draw_wrenches,
        "path": _draw_path,
    }
    if not log.wrenches:
        del plots["wrenches"]
    if "error" in log.topics:
        plots["error"] = _draw_error
    if has_autopilot(log):
        plots["autopilot"] = _draw_autopilot
    drawings = {}
    for name, draw_plot in plots.items():
        drawings[name] = finish(draw_plot(log), is_on_page)
        save_drawings(directory, {name: drawings[name]})
    return drawings


def draw_overview(log: Trajectory) -> Figure:
    """Draw position and attitude over time, side by side."""
    figure, grid = panels(_make_title(log, "Position and attitude of the frame"), 3, 2)
    _plot_components(grid[:, 0], log.time, log.position, _PLACES)
    _plot_components(grid[:, 1], log.time, np.degrees(unwrap_angles(log.rpy)), _ANGLES)
    return figure


def _draw_position(log: Trajectory) -> Figure:
    figure, grid = panels(_make_title(log, "Position of the frame"), 3)
    _plot_components(grid[:, 0], log.time, log.position, _PLACES)
    reference = _reference_position(log)
    if reference is not None:
        for axes, curve in zip(grid[:, 0], reference.T):
            axes.plot(log.time, curve, **REFERENCE)
        grid[0, 0].lines[0].set_label("flight")
        _add_legend(figure, grid[0, 0])
    return figure


def _draw_error(log: Trajectory) -> Figure:
    figure, grid = panels(_make_title(log, "Tracking error, frame minus reference"), 4)
    error = np.column_stack([log.topics["error"][axis] for axis in "xyz"])
    error = np.column_stack([error, np.linalg.norm(error, axis=1)])
    _plot_components(grid[:, 0], log.time, error, (*_PLACES, "norm (m)"))
    return figure


def _draw_autopilot(log: Trajectory) -> Figure:
    return draw_autopilot(log, _make_title(log, "Autopilot: estimate minus truth, mode and arming"))


def _reference_position(log: Trajectory) -> Any:
    """Return the position of the reference, (rows, 3), or None without one."""
    fields = log.topics.get("reference", {})
    if not {"x", "y", "z"} <= set(fields):
        return None
    return np.column_stack([fields[axis] for axis in "xyz"])


def _draw_attitude(log: Trajectory) -> Figure:
    figure, grid = panels(_make_title(log, "Attitude of the frame"), 3)
    _plot_components(grid[:, 0], log.time, np.degrees(unwrap_angles(log.rpy)), _ANGLES)
    return figure


def _draw_rates(log: Trajectory) -> Figure:
    title = _make_title(log, "Linear (world) and angular (body) velocity of the frame")
    figure, grid = panels(title, 3, 2)
    _plot_components(grid[:, 0], log.time, log.linear_velocity, [f"$v_{a}$ (m/s)" for a in "xyz"])
    angular = [rf"$\omega_{axis}$ (rad/s)" for axis in "xyz"]
    _plot_components(grid[:, 1], log.time, log.angular_velocity, angular)
    return figure


def _draw_rotors(log: Trajectory) -> Figure:
    """Draw a panel for each rotor, as curves of rotors that turn alike would hide each other."""
    speeds = np.abs(log.rotor_velocity)
    count = speeds.shape[1]
    what = "Speed of the rotor joints"
    low, high = _choose_speed_limits(speeds)
    if speeds.min(initial=low) < low:
        what += f" (cut off below {low:.3g} rad/s)"
    figure, grid = panels(
        _make_title(log, what), max(1, count), height=1.5, right=0.8 if log.is_slow else 0.1
    )
    for i, (axes, speed) in enumerate(zip(grid[:, 0], speeds.T)):
        axes.plot(log.time, speed, color=PALETTE[i % len(PALETTE)], linewidth=1)
        axes.set_ylabel(f"rotor {i + 1} (rad/s)")
        axes.set_ylim(low, high)
        if log.is_slow:
            add_unslowed_axis(axes, log.per_command)
    return figure


def _choose_speed_limits(speeds: np.ndarray) -> Tuple[float, float]:
    """Choose limits in which the differences that steer, a hundredth of the speed, are visible."""
    if not speeds.size:
        return 0.0, 1.0
    low, high = speeds.min(), speeds.max()
    usual = np.percentile(speeds, 5)
    if high - low > 5 * (high - usual):  # a short spin-up would set the scale
        low = usual
    margin = 0.05 * (high - low) or 1.0
    return low - margin, high + margin


def _draw_wrenches(log: Trajectory) -> Figure:
    sizes = {name: np.abs(wrench).max(initial=0) for name, wrench in log.wrenches.items()}
    acting = {name: wrench for name, wrench in log.wrenches.items() if sizes[name] > _NO_FORCE}
    title = _make_title(log, "Wrenches about the centre of mass, frame axes")
    figure, grid = panels(title, max(1, len(acting)), 2)
    grid[0, 0].set_title("force (N)", fontsize="medium")
    grid[0, 1].set_title("torque (N m)", fontsize="medium")
    for row, (name, wrench) in zip(grid, acting.items()):
        row[0].set_ylabel(name)
        for axes, part in ((row[0], wrench[:, :3]), (row[1], wrench[:, 3:])):
            for values, colour, axis in zip(part.T, AXES, "xyz"):
                axes.plot(log.time, values, color=colour, label=axis)
            flatten(axes, _NO_FORCE)
    _add_legend(figure, grid[0, 0])
    return figure


def _draw_path(log: Trajectory) -> Figure:
    figure = make_figure(_make_title(log, "Path of the frame"), 6, 6)
    axes, corner = space(figure, WHOLE, [log.position])
    x, y, z = log.position.T
    axes.plot(
        x,
        y,
        np.full_like(z, corner[2]),
        color=AXES[2],
        alpha=0.35,
        linewidth=1,
        label="ground track",
    )
    axes.plot(x, y, z, color=AXES[2], label="path")
    reference = _reference_position(log)
    if reference is not None:
        axes.plot(*reference.T, **REFERENCE)
    axes.plot(x[:1], y[:1], z[:1], "o", color="black", markersize=5, label="start")
    axes.plot(x[-1:], y[-1:], z[-1:], "s", color="black", markersize=5, label="end")
    axes.legend(loc="upper right", frameon=False)
    return figure


def _make_title(log: Trajectory, what: str) -> str:
    return f"{what}: {log.title}" if log.title else what


def _add_legend(figure: Figure, axes: Any) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="upper right", ncol=max(1, len(labels)), frameon=False,
        handlelength=1.0, columnspacing=1.0,
    )  # fmt: skip


def _plot_components(
    panels: Any, time: np.ndarray, values: np.ndarray, labels: Sequence[str]
) -> None:
    for axes, curve, colour, label in zip(panels, values.T, (*AXES, "black"), labels):
        axes.plot(time, curve, color=colour)
        axes.set_ylabel(label)
        flatten(axes, NOTHING)
