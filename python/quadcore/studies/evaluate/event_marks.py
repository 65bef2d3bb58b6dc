"""Events of scenarios in pictures over time."""

from __future__ import annotations

from itertools import product
from typing import Any, Dict, List, Mapping, Sequence

from ...simulation.scenario_events import Event


def mark(figure: Any, events: Mapping[str, Sequence[Event]]) -> None:
    """Draw a line at the time of each event, with what happens and, among several, where.

    Parameters
    ----------
    figure
        Of motion over time.
    events
        By scenario.
    """
    marks: Dict[float, List[str]] = {}
    for scenario, happening in events.items():
        for event in happening:
            text = event.text if len(events) == 1 else f"{scenario}: {event.text}"
            marks.setdefault(event.time, []).append(text)
    for axes, (time, told) in product(figure.axes, marks.items()):
        if time > axes.get_xlim()[1]:
            continue
        axes.axvline(time, color="0.6", linewidth=0.8, linestyle=":", zorder=0)
        axes.annotate(
            ", ".join(told),
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
