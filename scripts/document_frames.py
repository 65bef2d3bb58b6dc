#!/usr/bin/env python3
"""Draw the frames of quadcore beside NED and FRD: ``scripts/document`` runs it."""

from __future__ import annotations

from typing import Any, List

import numpy as np
from images import save
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation

import quadcore as qc
from quadcore.report.colours import PALETTE
from quadcore.report.plots import png

AXES = (PALETTE[1], PALETTE[2], PALETTE[0])
TURNS = (PALETTE[0], PALETTE[1])  # rotors that turn positively, negatively
BODY = np.array([0.95, 0.65, 0.75])  # m, where the vehicle is drawn
ATTITUDE = Rotation.from_euler("z", -15, degrees=True).as_matrix()
NED = np.array([[0, 1, 0], [1, 0, 0], [0, 0, -1]])
FRD = np.diag([1, -1, -1])


def draw_axes(
    axes: Any, origin: np.ndarray, directions: np.ndarray, names: List[str], size: float
) -> None:
    """Draw three arrows, columns of `directions`, with their names."""
    for name, colour, direction in zip(names, AXES, directions.T):
        axes.quiver(
            *origin, *(size * direction), color=colour, linewidth=2, arrow_length_ratio=0.15
        )
        at = origin + (size + 0.1) * direction
        axes.text(*at, name, color=colour, ha="center", va="center", fontsize="small")


def draw_vehicle(axes: Any, sim: qc.Simulation) -> None:
    """Draw arms, and rotors with number and the sense in which they turn."""
    for number, (rotor, speed) in enumerate(zip(sim.rotors, sim.hover_speed), start=1):
        place = 1.6 * np.array(rotor.position)
        colour = TURNS[int(speed < 0)]
        axes.plot(*np.stack([BODY, BODY + ATTITUDE @ place]).T, color="0.6", linewidth=3)
        turn = np.linspace(0, 2 * np.pi, 61)[:, None]
        rim = place + 0.2 * (np.cos(turn) * [1, 0, 0] + np.sin(turn) * [0, 1, 0])
        axes.plot(*(BODY + rim @ ATTITUDE.T).T, color=colour, linewidth=1.4)
        for at in (19, 49):  # points of the rim with an arrow head
            along = (rim[at + 1] - rim[at]) * np.sign(speed)
            head = 6 * ATTITUDE @ along
            axes.quiver(
                *(BODY + ATTITUDE @ rim[at] - head / 2), *head,
                color=colour, linewidth=1.4, arrow_length_ratio=0.9,
            )  # fmt: skip
        axes.text(*(BODY + ATTITUDE @ place), str(number), color=colour, ha="center", va="center")


def name_axes(*meanings: str) -> List[str]:
    """Return the axes' names with what each points to."""
    return [f"{axis} ({meaning})" for axis, meaning in zip("xyz", meanings)]


def main() -> None:
    """Draw both conventions."""
    sim = qc.Simulation("quadrotor", xacro_args={"sim_slow": 1})
    figure = Figure(figsize=(10, 4.4), dpi=120)
    for column, title in enumerate(("world ENU, body FLU", "world NED, body FRD")):
        axes = figure.add_axes((0.5 * column, -0.02, 0.5, 1.0), projection="3d")
        axes.set_axis_off()
        axes.view_init(elev=28, azim=-58)
        for name in "xyz":
            getattr(axes, f"set_{name}lim")(-0.1, 1.4)
        axes.set_box_aspect((1, 1, 1), zoom=1.3)
        draw_vehicle(axes, sim)
        if column == 0:
            figure.text(0.03, 0.93, f"quadcore: {title}")
            draw_axes(axes, np.zeros(3), np.eye(3), name_axes("east", "north", "up"), 0.55)
            draw_axes(axes, BODY, ATTITUDE, name_axes("forward", "left", "up"), 0.62)
        else:
            figure.text(0.53, 0.93, f"PX4, ArduPilot: {title}")
            origin = np.array([0, 0, 0.45])
            draw_axes(axes, origin, NED.T, name_axes("north", "east", "down"), 0.55)
            draw_axes(axes, BODY, ATTITUDE @ FRD, name_axes("forward", "right", "down"), 0.62)
    save("frames", png(figure))


if __name__ == "__main__":
    main()
