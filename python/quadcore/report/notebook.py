"""What a notebook shows of quadcore's objects: HTML that needs no script."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Iterable, Sequence

import numpy as np

from ..studies.table import number_text, shown_in
from ..support.rotation import roll_pitch_yaw

if TYPE_CHECKING:
    from ..simulation.log import Log
    from ..simulation.simulation import Simulation
    from ..studies.compare.result import Comparison
    from ..studies.evaluate.evaluate import Evaluation

_ROWS = 30


def simulation_html(simulation: Simulation) -> str:
    """Show what flies, and its state."""
    state = simulation.state
    rows = [
        ("vehicle", f"{simulation.mass:.6g} kg, {simulation.rotor_count} rotors"),
        ("engine", f"{simulation.engine}, steps of {simulation.dt:g} s"),
        ("plugins", ", ".join(plugin.name for plugin in simulation.plugins)),
        ("time", f"{simulation.time:g} s"),
        ("position", f"{_numbers(state.position)} m"),
        ("roll, pitch, yaw", f"{_numbers(np.degrees(roll_pitch_yaw(state.orientation)))} deg"),
        ("velocity", f"{_numbers(state.linear_velocity)} m/s"),
        ("rotors", f"{_numbers(state.rotor_velocity)} rad/s"),
    ]
    return f"<b>{escape(simulation.model.name)}</b>" + _table((), rows)


def log_html(log: Log) -> str:
    """Show a flight: path in space and over time, attitude."""
    head = f"<p>{escape(repr(log)[1:-1])}</p>"
    if len(log) == 0:
        return head
    from .log_pictures import glance
    from .page import picture
    from .plots import png

    return head + str(picture(png(glance(log)), "position and attitude over time"))


def comparison_html(comparison: Comparison) -> str:
    """Show a row for each flight: how far it came from the reference."""
    table = comparison.table
    names = table.dtype.names or ()
    axes = [name for name in names[: names.index("failure")] if len(set(table[name])) > 1]
    states = list(comparison.states)[:4]
    units = {name: shown_in(comparison.states[name]) for name in states}
    heads = [*axes, *(f"largest {name} ({unit})" for name, (unit, _) in units.items())]
    rows = []
    for row in table[:_ROWS]:
        cells = [number_text(row[f"largest_{name}"] * units[name][1]) for name in states]
        rows.append(
            [*(str(row[axis]) for axis in axes), *([row["failure"]] if row["failure"] else cells)]
        )
    return f"<p>{escape(repr(comparison)[1:-1])}</p>" + _table(heads, rows, len(table))


def evaluation_html(evaluation: Evaluation) -> str:
    """Show a row for each combination."""
    from ..studies.evaluate.output import columns_to_read, rows_to_read

    lines = rows_to_read(evaluation)
    shown = {**columns_to_read(lines), "best": ""}
    rows = [[line[name] for name in shown] for line in lines[:_ROWS]]
    head = f"<p>{escape(repr(evaluation)[1:-1])}</p>"
    return head + _table(list(shown.values()), rows, len(lines))


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]], count: int = 0) -> str:
    head = "".join(f"<th>{escape(cell)}</th>" for cell in heads)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows
    )
    more = f"<p>{count - _ROWS} more</p>" if count > _ROWS else ""
    top = f"<thead><tr>{head}</tr></thead>" if heads else ""
    return f"<table>{top}<tbody>{body}</tbody></table>{more}"


def _numbers(values: np.ndarray) -> str:
    return ", ".join(f"{round(float(value), 4) + 0.0:g}" for value in values)
