"""Plots under an animation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Sequence, Tuple

import numpy as np

from ..support.rotation import unwrap_angles
from .packing import Numbers, choose_quantum, finite_or_none, make_plot_times, pick_extremes
from .player_flight import WIND, PlayerFlight

if TYPE_CHECKING:
    from ..simulation.trajectory import Trajectory


def pack_plots(flights: Sequence[PlayerFlight], numbers: Numbers) -> List[Dict[str, Any]]:
    """Describe the plots under the animation."""
    begin = min(float(flight.log.time[0]) for flight in flights)
    end = max(float(flight.log.time[-1]) for flight in flights)
    time = numbers.add(make_plot_times(begin, end))
    panels: Dict[str, Dict[str, Any]] = {}
    for number, flight in enumerate(flights):
        for title, part, values in _list_curves(flight.log):
            panel = panels.setdefault(
                title,
                {"name": title, "time": time, "least": _PANELS[title], "curves": [], "limits": []},
            )
            reduced = pick_extremes(flight.log.time, values, begin, end)
            packed = numbers.add(reduced, choose_quantum(reduced))
            panel["curves"].append({"flight": number, "part": part, "values": packed})
            limit = finite_or_none(flight.speed_limit)
            if title == _ROTORS and limit is not None and limit not in panel["limits"]:
                panel["limits"].append(limit)
    order = {name: i for i, name in enumerate(_PANELS)}
    return sorted(panels.values(), key=lambda panel: order[panel["name"]])


_ROTORS = "Rotor speed (rad/s)"
_PANELS = {
    "Tracking error (m)": 1e-7,
    "Height (m)": 1e-3,
    "Attitude (deg)": 1e-3,
    _ROTORS: 1e-2,
    "Wind speed (m/s)": 1e-2,
}
"""Plots in their order, and the range below which a curve is a flat line."""


def _list_curves(log: Trajectory) -> List[Tuple[str, str, np.ndarray]]:
    """List panel, part of the vehicle ("": the whole) and values of each curve."""
    curves: List[Tuple[str, str, np.ndarray]] = [("Height (m)", "", log.position[:, 2])]
    with np.errstate(all="ignore"):
        reference = log.topics.get("reference", {})
        if set("xyz") <= set(reference):
            away = log.position - np.column_stack([reference[axis] for axis in "xyz"])
            curves.append(("Tracking error (m)", "", np.linalg.norm(away, axis=1)))
        angles = np.degrees(unwrap_angles(log.rpy))
        curves += [
            ("Attitude (deg)", name, angle)
            for name, angle in zip(("roll", "pitch", "yaw"), angles.T)
        ]
        speeds = np.abs(log.rotor_velocity)
        curves += [(_ROTORS, f"rotor {i}", speed) for i, speed in enumerate(speeds.T, start=1)]
        wind = log.topics.get(WIND, {})
        if set("xyz") <= set(wind):
            vector = np.column_stack([wind[axis] for axis in "xyz"])
            curves.append(("Wind speed (m/s)", "", np.linalg.norm(vector, axis=1)))
    return curves
