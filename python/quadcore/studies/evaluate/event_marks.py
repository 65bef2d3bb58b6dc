"""Markers for scenario events in plots over time."""

from __future__ import annotations

from typing import Any, Dict, List, Sequence

from ...simulation.scenario_events import Event


def mark_events(figure: Any, events: Sequence[Event]) -> None:
    """Draw a labelled line at the time of each event.

    Parameters
    ----------
    figure
        Figure with plots over time.
    events
        Events of the scenario.
    """
    texts: Dict[float, List[str]] = {}
    for event in events:
        texts.setdefault(event.time, []).append(event.text)
    for axes in figure.axes:
        for time, happening in texts.items():
            if time <= axes.get_xlim()[1]:
                _mark(axes, time, ", ".join(happening))


def _mark(axes: Any, time: float, text: str) -> None:
    axes.axvline(time, color="0.6", linewidth=0.8, linestyle=":", zorder=0)
    axes.annotate(
        text,
        (time, 1),
        (2, -2),
        xycoords=("data", "axes fraction"),
        textcoords="offset points",
        rotation=90,
        va="top",
        fontsize=6,
        color="0.4",
        gid="event",
    )
