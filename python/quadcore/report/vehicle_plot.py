"""Plot of a vehicle: frames, masses, equivalent inertia boxes, rotors with number and spin."""

from __future__ import annotations

import textwrap
from itertools import groupby
from typing import TYPE_CHECKING, Any, List, NamedTuple, Tuple

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyArrowPatch

from .. import _core
from .._core import InputError
from .colours import PALETTE
from .plots import AXES, make_figure, space

if TYPE_CHECKING:
    from ..simulation.simulation import Simulation

_FRAME, _AHEAD, _BACK, _STILL = "0.35", PALETTE[0], PALETTE[1], "0.6"
_TRIAD, _ABOVE = 0.6, 0.68  # disc radii: length of a rotor's axes, distance of its number
_BACKGROUND = {"facecolor": "white", "edgecolor": "none", "pad": 1}  # behind text
_EDGES = [(i, j) for i in range(8) for j in range(i) if bin(i ^ j).count("1") == 1]


class _Rotor(NamedTuple):
    number: int
    name: str
    mass: float
    place: np.ndarray
    """Origin of the link in the frame, m."""
    axis: np.ndarray
    """Unit vector in the frame."""
    rate: float
    """Joint velocity in hover, rad/s; NaN if unknown."""
    command: float
    """Command for that velocity, rad/s."""

    @property
    def colour(self) -> str:
        turn = self.rate * self.axis[2]
        return _STILL if np.isnan(turn) or turn == 0 else _AHEAD if turn > 0 else _BACK


def draw(simulation: Simulation) -> Figure:
    """Draw the vehicle of a simulation in 3D and from above, all joints at angle zero."""
    rotors, model = _rotors(simulation), simulation.model
    boxes = [_box(link, pose) for link, pose in zip(model.links, model.link_poses)]
    radius = model.drawn_disc_radius
    figure = make_figure("", 11, 6.2)
    rims = [rotor.place + s * radius for rotor in rotors for s in (-1, 1)]
    title = f"{model.name}: {simulation.mass:.6g} kg, {len(rotors)} rotors"
    axes = space(figure, (-0.02, 0.14, 0.52, 0.82), [*boxes, np.array(rims).reshape(-1, 3)])[0]
    figure.suptitle(title, x=0.01, y=0.985, ha="left", va="top", fontsize="medium")
    for box, colour in zip(boxes, [_FRAME, *(rotor.colour for rotor in rotors)]):
        for edge in _EDGES:
            axes.plot(*box[list(edge)].T, color=colour, linewidth=0.9)
    for rotor in rotors:
        rim = _rim(rotor, radius)
        axes.plot(*rim.T, color=rotor.colour, linewidth=1)
        above = rotor.place + _ABOVE * radius * rotor.axis
        axes.text(*above, str(rotor.number), color=rotor.colour, ha="center")
    for pose, length in zip(model.link_poses, [1.2 * radius, *[_TRIAD * radius] * len(rotors)]):
        _triad(axes, pose, length)
    axes.plot(*simulation.center_of_mass[:, None], "o", color="black", markersize=4)
    _from_above(figure.add_axes((0.56, 0.22, 0.43, 0.7)), simulation, rotors, boxes, radius)
    figure.text(0.01, 0.015, _describe(simulation, rotors), fontsize="small", va="bottom")
    return figure


def _rotors(simulation: Simulation) -> List[_Rotor]:
    model = simulation.model
    try:
        hover = _core.ReferenceShape("hover", {}).at(0.0)
        rates = _core.start_on(simulation, hover, [])["rotor_velocity"]
    except InputError:  # no motors, or too little thrust to hover
        rates = np.full(simulation.rotor_count, np.nan)
    commands = rates / [rotor.rate_per_command for rotor in simulation.rotors]
    parts = zip(model.joints, model.links[1:], model.link_poses[1:], rates, commands)
    return [
        _Rotor(i, joint.name, link.mass, pose[:3, 3], pose[:3, :3] @ joint.axis, rate, command)
        for i, (joint, link, pose, rate, command) in enumerate(parts, start=1)
    ]


def _box(link: _core.Link, pose: np.ndarray) -> np.ndarray:
    """Return the corners of a link's equivalent inertia box in the frame; shape (8, 3)."""
    return np.asarray(link.inertia_box @ pose[:3, :3].T + pose[:3, 3])


def _rim(rotor: _Rotor, radius: float) -> np.ndarray:
    across = np.cross(rotor.axis, [0, 1, 0] if abs(rotor.axis[1]) < 0.9 else [1, 0, 0])
    across /= np.linalg.norm(across)
    angle = np.linspace(0, 2 * np.pi, 61)[:, None]
    turned = np.cos(angle) * across + np.sin(angle) * np.cross(rotor.axis, across)
    return np.asarray(rotor.place + radius * turned)


def _triad(axes: Any, pose: np.ndarray, length: float) -> None:
    for name, colour, direction in zip("xyz", AXES, pose[:3, :3].T):
        tip = pose[:3, 3] + length * direction
        axes.plot(*np.stack([pose[:3, 3], tip]).T, color=colour, linewidth=1.4)
        if np.allclose(pose, np.eye(4)):  # the frame
            axes.text(*(pose[:3, 3] + 1.12 * length * direction), name, color=colour)


def _from_above(
    axes: Any, simulation: Simulation, rotors: List[_Rotor], boxes: List[np.ndarray], radius: float
) -> None:
    axes.set_aspect("equal")
    axes.plot(*_outline(boxes[0]), color=_FRAME, linewidth=0.9)
    for rotor in rotors:
        x, y, _ = rotor.place
        axes.plot([0, x], [0, y], color="0.85", linewidth=3, zorder=0)
        axes.add_patch(Circle((x, y), radius, fill=False, color=rotor.colour))
        _spin(axes, rotor, 0.75 * radius)
        axes.text(x, y, str(rotor.number), ha="center", va="center", color=rotor.colour)
        if not np.isnan(rotor.command):
            text = f"{rotor.command:+.4g}"
            where = (x, y - 0.45 * radius)
            axes.text(*where, text, ha="center", va="center", fontsize="x-small", bbox=_BACKGROUND)
    for name, colour, tip in zip("xy", AXES, np.eye(2)):
        axes.annotate(
            "", 0.8 * radius * tip, (0, 0), arrowprops={"arrowstyle": "->", "color": colour}
        )
        axes.text(*(0.95 * radius * tip), name, color=colour, ha="center", va="center")
    axes.plot(*simulation.center_of_mass[:2], "o", color="black", markersize=4)
    axes.set_title("top view with hover commands (rad/s)", fontsize="small", loc="left")
    axes.margins(0.12)
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.grid(color="0.93", linewidth=0.6)
    axes.set_axisbelow(True)


def _spin(axes: Any, rotor: _Rotor, radius: float) -> None:
    """Draw an arrow in the direction of rotation, seen from above."""
    if rotor.colour == _STILL:
        return
    ends = np.radians([150, 30] if rotor.colour == _BACK else [30, 150])
    x, y, _ = rotor.place
    start, end = ((x + radius * np.cos(angle), y + radius * np.sin(angle)) for angle in ends)
    bend = -0.55 if rotor.colour == _BACK else 0.55
    axes.add_patch(
        FancyArrowPatch(
            start, end, connectionstyle=f"arc3,rad={bend}", arrowstyle="-|>", mutation_scale=9,
            color=rotor.colour, linewidth=1.2,
        )
    )  # fmt: skip


def _outline(box: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    low, high = box.min(axis=0), box.max(axis=0)
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)])
    return low[0] + corners[:, 0] * (high - low)[0], low[1] + corners[:, 1] * (high - low)[1]


def _describe(simulation: Simulation, rotors: List[_Rotor]) -> str:
    frame = simulation.model.links[0]
    masses = f"{frame.name} {frame.mass:.4g} kg"
    for mass, group in groupby(rotors, key=lambda rotor: rotor.mass):
        masses += "; " + ", ".join(f"{rotor.number} {rotor.name}" for rotor in group)
        masses += f" {mass:.4g} kg each"
    return (
        textwrap.fill(masses, 150)
        + f"\nvehicle: centre of mass (dot) at ({_numbers(simulation.center_of_mass)}) m; Ixx, "
        f"Iyy, Izz about it {_numbers(np.diag(simulation.inertia))} kg m$^2$\n"
        "Boxes: equivalent inertia box of each link. In hover, blue rotors turn counter-clockwise "
        "seen from above, orange ones clockwise."
    )


def _numbers(values: np.ndarray) -> str:
    return ", ".join(f"{round(float(value), 7) + 0.0:.4g}" for value in values)
