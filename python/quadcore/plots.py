"""Pictures of a flight."""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Sequence, Tuple

import numpy as np

from .colours import PALETTE
from .files import atomic_write, make_folder
from .rotation import continuous

# Files need no window, and a wrong name of a toolkit for windows must not end a flight.
_toolkit = os.environ.pop("MPLBACKEND", None)
try:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.ticker import ScalarFormatter
    from mpl_toolkits.mplot3d import Axes3D  # noqa: F401  (matplotlib < 3.2 needs it for "3d")
finally:
    if _toolkit is not None:
        os.environ["MPLBACKEND"] = _toolkit

if TYPE_CHECKING:
    from .trajectory import Trajectory

# x, y, z keep theirs throughout.
AXES = ("#d55e00", "#009e73", "#0072b2")
WHOLE = (0.0, 0.02, 0.94, 0.94)  # of a figure that axes in space fill
NOTHING = 1e-6  # m, m/s, rad/s, deg: a range below which there is rounding to be seen
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


def png(figure: Figure) -> bytes:
    """Picture of a figure; the same flight gives the same bytes."""
    FigureCanvasAgg(figure)
    stream = io.BytesIO()
    figure.savefig(stream, format="png", metadata={"Software": "quadcore"})  # and no version
    return stream.getvalue()


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
        as_commanded(close[0], log.per_command)
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


def as_commanded(axes: Any, per_command: float) -> None:
    """Tell speeds of joints as commanded, too, on the right."""
    to_command = (lambda rate: rate / per_command, lambda told: told * per_command)
    axes.secondary_yaxis("right", functions=to_command).set_ylabel("commanded (rad/s)")


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
    figure = titled(_title(log, "Path of the frame"), 6, 6)
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


def space(figure: Figure, place: Any, paths: Sequence[np.ndarray]) -> Tuple[Any, np.ndarray]:
    """Put axes in space into a figure, with room for paths, each (rows, 3).

    Returns the axes and their low corner.
    """
    axes = figure.add_axes(place, projection="3d")
    # The same scale along all three axes, with room for flights that hardly move.
    low = np.min([path.min(axis=0) for path in paths], axis=0)
    high = np.max([path.max(axis=0) for path in paths], axis=0)
    reach = max((high - low).max() / 2, 0.1)
    corner = (low + high) / 2 - reach
    for name, start in zip("xyz", corner):
        getattr(axes, f"set_{name}lim")(start, start + 2 * reach)
        getattr(axes, f"set_{name}label")(f"{name} (m)")
    axes.locator_params(nbins=5, prune="both")  # neighbours do not touch
    return axes, corner


def panels(
    title: str,
    rows: int,
    columns: int = 1,
    height: float = 1.6,
    above: float = 0.5,
    right: float = 0.1,
) -> tuple[Figure, Any]:
    """Make a figure of panels over time, `height` inches each, with room for title and legend."""
    width, below = (8.0 if columns > 1 else 7.0), 0.5  # inch
    total = above + height * rows + below
    figure = titled(title, width, total)
    # Fixed margins: matplotlib's automatic layouts differ from version to version.
    margins = {
        "left": 1.1 / width,
        "right": 1 - right / width,
        "top": 1 - above / total,
        "bottom": below / total,
        "wspace": 0.38,
        "hspace": 0.18,
    }
    grid = subplots(figure, rows, columns, margins, sharex=True)
    for axes in grid[-1]:
        axes.set_xlabel("time (s)")
    return figure, grid


def subplots(figure: Figure, rows: int, columns: int, margins: Any, **shared: Any) -> Any:
    """Put dressed panels into a figure, whose numbers have nine signs at most."""
    grid = figure.subplots(rows, columns, squeeze=False, gridspec_kw=margins, **shared)
    for axes in grid.flat:
        dress(axes)
        axes.yaxis.set_major_formatter(_Numbers())
        axes.ticklabel_format(axis="y", scilimits=(-3, 4))
    figure.align_ylabels(grid)
    return grid


class _Numbers(ScalarFormatter):
    """Has a number of its own for what all share only where that saves so many digits.

    Matplotlib has but a setting of the whole process for it, which other threads would feel.
    """

    def __init__(self) -> None:
        super().__init__()
        self._offset_threshold = 7


def dress(axes: Any) -> None:
    """Give a panel the style of all."""
    axes.grid(color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.margins(x=0.01)
    axes.spines["top"].set_visible(False)
    axes.spines["right"].set_visible(False)


def widen(axes: Any, least: float) -> None:
    """Show a range of at least that much, so that rounding is a flat line."""
    low, high = axes.get_ylim()
    if high - low < least:
        middle = (low + high) / 2
        axes.set_ylim(middle - least / 2, middle + least / 2)


def flatten(axes: Any, least: float) -> None:
    """Show what moves less than that much as a flat line on a scale of one unit."""
    low, high = axes.dataLim.intervaly
    if high - low < least:
        middle = round((low + high) / 2, 3) + 0.0
        axes.set_ylim(middle - 1, middle + 1)
        axes.set_yticks([middle])


def _title(log: Trajectory, what: str) -> str:
    return f"{what}: {log.title}" if log.title else what


def titled(title: str, width: float, height: float, dpi: int = 150) -> Figure:
    """Make an empty figure, its size in inches."""
    figure = Figure(figsize=(width, height), dpi=dpi)
    figure.suptitle(
        title, x=0.1 / width, y=1 - 0.1 / height, ha="left", va="top", fontsize="medium"
    )
    return figure


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
