"""Pictures of a flight."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Sequence

import numpy as np

from ..support.output_files import atomic_write, make_folder
from ..support.rotation import continuous
from .colours import PALETTE
from .plots import (
    AXES,
    NOTHING,
    WHOLE,
    add_commanded_axis,
    flatten,
    make_figure,
    panels,
    png,
    space,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..simulation.trajectory import Trajectory

_NO_FORCE = 1e-9  # N, N m
_PLACES = ("x (m)", "y (m)", "z (m)")
_ANGLES = ("roll (deg)", "pitch (deg)", "yaw (deg)")


def draw(log: Trajectory, directory: Path) -> list[Path]:
    """Draw every picture of `log` into `directory`, which is made if missing.

    Returns
    -------
    list of Path
        The PNG files written.

    Raises
    ------
    InputError
        The folder or a file cannot be written.
    """
    make_folder(directory)
    pictures: dict[str, Callable[[Trajectory], Figure]] = {
        "position": _position,
        "attitude": _attitude,
        "rates": _rates,
        "rotors": _rotors,
        "wrenches": _wrenches,
        "path": _path,
    }
    if not log.wrenches:
        del pictures["wrenches"]
    if "error" in log.topics:
        pictures["error"] = _error
    written = []
    for name, picture in pictures.items():
        file = directory / f"{name}.png"
        with atomic_write(file) as stream:
            stream.write(png(picture(log)))
        written.append(file)
    return written


def glance(log: Trajectory) -> Figure:
    """Draw position and attitude over time, side by side."""
    figure, grid = panels(_title(log, "Position and attitude of the frame"), 3, 2)
    _curves(grid[:, 0], log.time, log.position, _PLACES)
    _curves(grid[:, 1], log.time, np.degrees(continuous(log.rpy)), _ANGLES)
    return figure


def _position(log: Trajectory) -> Figure:
    figure, grid = panels(_title(log, "Position of the frame"), 3)
    _curves(grid[:, 0], log.time, log.position, _PLACES)
    wanted = _wanted(log)
    if wanted is not None:
        for axes, curve in zip(grid[:, 0], wanted.T):
            axes.plot(log.time, curve, "--", color="0.3", linewidth=1, label="reference")
        _legend(figure, grid[0, 0])
    return figure


def _error(log: Trajectory) -> Figure:
    figure, grid = panels(_title(log, "Error, frame less reference"), 4)
    error = np.column_stack([log.topics["error"][axis] for axis in "xyz"])
    _curves(grid[:, 0], log.time, error, ("x (m)", "y (m)", "z (m)"))
    grid[3, 0].plot(log.time, np.linalg.norm(error, axis=1), color="black")
    grid[3, 0].set_ylabel("length (m)")
    return figure


def _wanted(log: Trajectory) -> Any:
    """Position of the reference, (rows, 3), or None without one."""
    fields = log.topics.get("reference", {})
    if not {"x", "y", "z"} <= set(fields):
        return None
    return np.column_stack([fields[axis] for axis in "xyz"])


def _attitude(log: Trajectory) -> Figure:
    figure, grid = panels(_title(log, "Attitude of the frame"), 3)
    _curves(grid[:, 0], log.time, np.degrees(continuous(log.rpy)), _ANGLES)
    return figure


def _rates(log: Trajectory) -> Figure:
    title = _title(log, "Linear (world) and angular (body) velocity of the frame")
    figure, grid = panels(title, 3, 2)
    _curves(grid[:, 0], log.time, log.linear_velocity, [f"$v_{a}$ (m/s)" for a in "xyz"])
    angular = [rf"$\omega_{axis}$ (rad/s)" for axis in "xyz"]
    _curves(grid[:, 1], log.time, log.angular_velocity, angular)
    return figure


def _rotors(log: Trajectory) -> Figure:
    title = _title(log, "Velocity of the rotor joints")
    figure, (whole, close) = panels(title, 2, height=2.2, right=0.8 if log.is_slow else 0.1)
    for i, velocity in enumerate(log.rotor_velocity.T):
        style = {"color": PALETTE[i % len(PALETTE)], "label": f"{i + 1}" if i else "rotor 1"}
        whole[0].plot(log.time, velocity, **style)
        close[0].plot(log.time, np.abs(velocity), **style)
    whole[0].set_ylabel("signed (rad/s)")
    if log.is_slow:
        add_commanded_axis(close[0], log.per_command)
    close[0].set_ylabel("magnitude (rad/s)")
    close[0].set_title("without the lowest 5 %", loc="left", fontsize="medium")
    # Around hover the differences that steer are a hundredth of the speed: show them large.
    speeds = np.abs(log.rotor_velocity)
    if speeds.size:
        low, high = np.percentile(speeds, 5), speeds.max()
        margin = 0.05 * (high - low) or 1.0
        close[0].set_ylim(low - margin, high + margin)
    _legend(figure, whole[0])
    return figure


def _wrenches(log: Trajectory) -> Figure:
    sizes = {name: np.abs(wrench).max(initial=0) for name, wrench in log.wrenches.items()}
    acting = {name: wrench for name, wrench in log.wrenches.items() if sizes[name] > _NO_FORCE}
    title = _title(log, "Wrenches about the centre of mass, frame axes")
    figure, grid = panels(title, max(1, len(acting)), 2)
    grid[0, 0].set_title("force (N)", fontsize="medium")
    grid[0, 1].set_title("torque (N m)", fontsize="medium")
    for row, (name, wrench) in zip(grid, acting.items()):
        row[0].set_ylabel(name)
        for axes, part in ((row[0], wrench[:, :3]), (row[1], wrench[:, 3:])):
            for values, colour, axis in zip(part.T, AXES, "xyz"):
                axes.plot(log.time, values, color=colour, label=axis)
            flatten(axes, _NO_FORCE)
    _legend(figure, grid[0, 0])
    return figure


def _path(log: Trajectory) -> Figure:
    figure = make_figure(_title(log, "Path of the frame"), 6, 6)
    axes, corner = space(figure, WHOLE, [log.position])
    x, y, z = log.position.T
    axes.plot(x, y, np.full_like(z, corner[2]), color="0.7", linewidth=1, label="seen from above")
    axes.plot(x, y, z, color=AXES[2], label="path")
    wanted = _wanted(log)
    if wanted is not None:
        axes.plot(*wanted.T, "--", color="0.3", linewidth=1, label="reference")
    axes.plot(x[:1], y[:1], z[:1], "o", color="black", markersize=5, label="start")
    axes.plot(x[-1:], y[-1:], z[-1:], "s", color="black", markersize=5, label="end")
    axes.legend(loc="upper right", frameon=False)
    return figure


def _title(log: Trajectory, what: str) -> str:
    return f"{what}: {log.title}" if log.title else what


def _legend(figure: Figure, axes: Any) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="upper right", ncol=max(1, len(labels)), frameon=False,
        handlelength=1.0, columnspacing=1.0,
    )  # fmt: skip


def _curves(panels: Any, time: np.ndarray, values: np.ndarray, labels: Sequence[str]) -> None:
    for axes, curve, colour, label in zip(panels, values.T, AXES, labels):
        axes.plot(time, curve, color=colour)
        axes.set_ylabel(label)
        flatten(axes, NOTHING)
