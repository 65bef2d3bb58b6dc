#!/usr/bin/env python3
"""Draw the figures of the README and the docs into docs/images: ``scripts/document`` runs it.

The script simulates every flight; the recordings of real Gazebo 11 are in tests/data/gazebo11.
"""

from __future__ import annotations

import io
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np
from images import save, save_in_few_colours
from matplotlib.figure import Figure
from PIL import Image

import quadcore as qc
from quadcore.report import vehicle_plot
from quadcore.report.plots import dress, png

ROOT = Path(__file__).resolve().parents[1]
DATA = ROOT / "tests" / "data" / "gazebo11"

sys.path.insert(0, str(ROOT / "examples"))
import spiral  # noqa: E402  (an example, no package)

COLOURS = spiral.COLOURS
WIDTHS = {"gazebo11": 1.6, "ode": 3.5, "eigen": 1.6}  # ode and eigen coincide
RECORDED = {"color": "black", "label": "real Gazebo 11 (recorded)", "linestyle": "none"}


def recording(path: Path) -> np.ndarray:
    """Return the rows of a recording, with the columns of a log."""
    return np.loadtxt(path, delimiter=",", skiprows=1)


def distance(log: qc.Log, rows: np.ndarray) -> np.ndarray:
    """Return the distance from the recording at each of its rows (m)."""
    at = np.searchsorted(log.time, rows[:, 0] - 1e-6)
    return np.linalg.norm(log.position[at] - rows[:, 1:4], axis=1)


def draw_flight() -> None:
    """Draw one open-loop manoeuvre in every engine and in real Gazebo."""
    rows = recording(DATA / "S5_slow1_all.csv.gz")
    logs = {
        engine: qc.Simulation("quadrotor", engine=engine, xacro_args={"sim_slow": 1}).run(
            10.0, commands=DATA / "commands_S5.csv"
        )
        for engine, _ in qc.engines()
    }
    figure = Figure(figsize=(10, 4.6), dpi=120)

    path = figure.add_axes((0.0, 0.04, 0.52, 0.96), projection="3d")
    for engine, log in logs.items():
        path.plot(*log.position.T, color=COLOURS[engine], linewidth=WIDTHS[engine], label=engine)
    path.plot(*rows[::2, 1:4].T, marker="o", markersize=4, fillstyle="none", **RECORDED)
    path.plot(*rows[:1, 1:4].T, "s", color="black", markersize=6, linestyle="none", label="start")
    low = np.min([log.position.min(axis=0) for log in logs.values()], axis=0)
    high = np.max([log.position.max(axis=0) for log in logs.values()], axis=0)
    path.set_box_aspect(high - low, zoom=0.95)
    for axis, ticks in zip("xyz", ([-5, 0, 5], [0, 4], [5, 10, 15])):
        getattr(path, f"set_{axis}ticks")(ticks)
        getattr(path, f"set_{axis}label")(f"{axis} (m)")
    path.view_init(elev=20, azim=-58)
    figure.legend(
        *path.get_legend_handles_labels(), loc="upper left", frameon=False, fontsize="small", ncol=2
    )

    apart = figure.add_axes((0.63, 0.13, 0.355, 0.76))
    for engine, log in logs.items():
        floor = np.maximum(distance(log, rows), 1e-17)
        apart.semilogy(rows[:, 0], floor, color=COLOURS[engine], linewidth=WIDTHS[engine])
    for engine, at in (("gazebo11", (6.1, 2e-12)), ("ode", (2.3, 1e-7)), ("eigen", (0.6, 4e-3))):
        apart.text(*at, engine, color=COLOURS[engine])
    apart.set_title("distance from real Gazebo 11 (m)", loc="left", fontsize="medium")
    apart.set_xlabel("time (s)")
    apart.set_ylim(1e-17, 1e3)
    apart.set_xlim(0, 10)
    dress(apart)
    save("flight", png(figure))


def draw_spiral() -> None:
    """Draw the thesis' spiral with retuned gains, and with the printed ones until they diverge."""
    flights = {
        "pid": (spiral.COLOURS["gazebo11"], "PID, retuned gains"),
        "pid_thesis": (spiral.COLOURS["eigen"], "PID, gains as printed in the thesis"),
    }
    study = qc.evaluate(list(flights), "spiral", "eigen", duration=20, xacro_args={"sim_slow": 1})
    figure = Figure(figsize=(10, 4.2), dpi=150)
    path = figure.add_axes((-0.02, 0.02, 0.46, 0.98), projection="3d")
    panel = figure.add_axes((0.51, 0.14, 0.47, 0.78))
    limit = 3.0  # m, where the figure ends a flight that diverges
    for row, outcome in zip(study.table, study.outcomes):
        colour, name = flights[row["controller"]]
        log = outcome.log
        error = np.linalg.norm([log.topics["error"][axis] for axis in "xyz"], axis=0)
        end = int(np.argmax(error > limit)) or len(error)
        lines = [
            path.plot(*log.position[:end].T, color=colour, linewidth=2)[0],
            panel.plot(log.time[:end], error[:end], color=colour, linewidth=2)[0],
        ]
        for line in lines if end < len(error) else []:
            line.set(clip_on=False, marker="X", markersize=9, markevery=[end - 1])
        at = (6.5, 2.6) if end < len(error) else (11, 0.15)
        panel.text(*at, name, color=colour)
    times = np.linspace(0, 20, 400)
    wanted = np.array([qc.references.spiral()(time).position for time in times])
    path.plot(*wanted.T, "--", color="0.2", linewidth=1, label="reference")
    for axis, ticks in zip("xyz", ([-2, 0, 2], [-2, 0, 2], [10, 20, 30])):
        getattr(path, f"set_{axis}label")(f"{axis} (m)")
        getattr(path, f"set_{axis}ticks")(ticks)
    path.set_box_aspect((1, 1, 1.5), zoom=0.84)
    path.view_init(elev=15, azim=-60)
    path.legend(frameon=False, loc="upper left", bbox_to_anchor=(0.12, 0.95))
    panel.set_xlabel("time (s)")
    panel.set_ylabel("tracking error (m)")
    panel.set_ylim(0, limit)
    dress(panel)
    save("spiral", png(figure))


def draw_wrenches() -> None:
    """Draw the wrenches of the same manoeuvre with the forces of chapter 2, as Log.plot does."""
    sim = qc.Simulation(
        "quadrotor",
        engine="eigen",
        xacro_args={"sim_slow": 1},
        parameters={"drone_plugin.dragModel": "chapter2"},
    )
    log = sim.run(10.0, commands=DATA / "commands_S5.csv", log_every=10, wrenches=True)
    with tempfile.TemporaryDirectory() as folder:
        log.plot(folder)
        save("wrenches", (Path(folder) / "wrenches.png").read_bytes())


def draw_contact() -> None:
    """Draw take-off and landing next to the recording."""
    case = DATA / "cases" / "C2_takeoff_land"
    rows = recording(case / "record.csv.gz")
    log = qc.Simulation(case / "model.urdf", world=case / "case.world", spawn=(0, 0, 0.1)).run(
        10.0, commands=case / "commands.csv"
    )
    figure = Figure(figsize=(8, 4.2), dpi=120)
    height, apart = figure.subplots(
        2, 1, sharex=True, gridspec_kw={"left": 0.1, "right": 0.98, "top": 0.97, "bottom": 0.11}
    )
    height.plot(log.time, log.position[:, 2], color=COLOURS["gazebo11"], label="gazebo11")
    every = np.searchsorted(rows[:, 0], np.arange(0, 10, 0.2))
    height.plot(
        rows[every, 0], rows[every, 3], marker="o", markersize=4, fillstyle="none", **RECORDED
    )
    height.set_ylabel("height of the frame (m)")
    height.legend(frameon=False)
    floor = np.maximum(distance(log, rows), 1e-18)
    apart.semilogy(rows[:, 0], floor, ".", markersize=4, color=COLOURS["gazebo11"])
    apart.set_ylabel("distance from it (m)")
    apart.set_ylim(1e-18, 1e-12)
    apart.set_xlabel("time (s)")
    for axes in (height, apart):
        dress(axes)
    save("contact", png(figure))


def draw_rotors() -> None:
    """Draw how far flights of RotorS' firefly are from their limit of small steps."""
    recorded = DATA.parent / "rotors" / "F3_firefly_multisine" / "commands.csv.gz"
    commands = np.loadtxt(recorded, delimiter=",", skiprows=1)

    def flown(engine: str, dt: float) -> np.ndarray:
        bare = {"sensors": "false"}
        simulation = qc.Simulation("firefly", engine=engine, dt=dt, xacro_args=bare)
        return simulation.run(10, commands=commands, log_every=round(0.05 / dt)).position

    flights = {
        "RotorS at its own 10 ms (gazebo11)": ("gazebo11", 0.01, "-"),
        "RotorS at 1 ms (gazebo11)": ("gazebo11", 0.001, "--"),
        "eigen at 10 ms": ("eigen", 0.01, "-"),
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the frame's inertia is not physical
        limit = flown("eigen", 0.000625)
        paths = {name: flown(engine, dt) for name, (engine, dt, _) in flights.items()}
    figure = Figure(figsize=(8, 3.6), dpi=120)
    axes = figure.add_axes((0.11, 0.14, 0.87, 0.82))
    for name, path in paths.items():
        engine, _, line = flights[name]
        apart = np.linalg.norm(path - limit, axis=1)[1:]
        times = 0.05 * np.arange(1, 1 + len(apart))
        axes.semilogy(times, apart, line, color=COLOURS[engine], label=name)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("distance from the limit\nof small steps (m)")
    axes.set_ylim(1e-6, 1e2)
    axes.legend(frameon=False, loc="lower right")
    dress(axes)
    save("rotors_steps", png(figure))


def draw_vehicle() -> None:
    """Draw the built-in quadrotor as ``quadcore info --picture`` does."""
    figure = vehicle_plot.draw(qc.Simulation("quadrotor", xacro_args={"sim_slow": 1}))
    save_in_few_colours("vehicle", Image.open(io.BytesIO(png(figure))))


if __name__ == "__main__":
    draw_spiral()
    draw_flight()
    draw_wrenches()
    draw_contact()
    draw_rotors()
    draw_vehicle()
