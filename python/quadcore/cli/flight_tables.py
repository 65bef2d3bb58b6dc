"""Tables about recordings of real flights."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Sequence

import numpy as np

from ..studies.fit.inputs import INPUTS
from ..studies.fit.windows import HORIZONS
from . import terminal

if TYPE_CHECKING:
    from ..studies.fit.judgement import Judgement
    from ..studies.fit.prepared import PreparedFlight
    from ..studies.fit.recorded import RecordedFit
    from ..studies.fit.replay import Replay


def show_flights(flights: Sequence[PreparedFlight]) -> None:
    """Print the alignment and the removed samples of each recording."""
    console = terminal.make_console()
    table = terminal.make_table("recording", "in the air", "topic", "lag", "left out")
    for flight in flights:
        span = f"{flight.span[1] - flight.span[0]:.1f} s"
        left = {(r.topic, f"{r.samples} samples: {r.reason}") for r in flight.removals}
        topics = sorted({*flight.lags, *(topic for topic, _ in left)})
        name = Path(flight.where).name
        if flight.tilt:
            topics.append("pose axes")
        for topic in topics or [""]:
            lag = f"{1e3 * flight.lags[topic]:.1f} ms" if topic in flight.lags else ""
            why = "; ".join(sorted(text for of, text in left if of == topic))
            if topic == "pose axes":
                why = f"turned by {flight.tilt:.1f} deg to the IMU"
            table.add_row(name, span, topic, lag, why)
            name = span = ""
        if len(flight.gaps):
            longest = float(np.max(flight.gaps[:, 1] - flight.gaps[:, 0]))
            table.add_row("", "", "gaps", "", f"{len(flight.gaps)}, the longest {longest:.2f} s")
    console.print(table, "")


def show_fit(fit: RecordedFit) -> None:
    """Print the parameters with their deviations, the trims, and unidentified parameters."""
    console = terminal.make_console()
    table = terminal.make_table("parameter", "start", "fitted", "std dev", "unit", numbers=True)
    found = fit.found
    for name, deviation in found.deviations.items():
        value = found.values[name]
        spread = "not identifiable" if math.isnan(deviation) else f"{deviation:.2g}"
        if name in INPUTS and deviation == 0:
            spread = "fixed"
        table.add_row(name, f"{found.start[name]:.5g}", f"{value:.5g}", spread, found.units[name])
    console.print(table, "")
    for line in fit.describe():
        console.print(line)
    for flight, trim in zip(fit.flights, found.trims):
        console.print(f"{Path(flight.where).name}: commands delayed by {1e3 * trim[0]:.0f} ms")
    console.print("")


def show_judgement(judgement: Judgement) -> None:
    """Print the prediction errors over the horizon."""
    console = terminal.make_console()
    heads = [f"{horizon:g} s" for horizon in HORIZONS]
    table = terminal.make_table("model", "error (RMS)", "unit", *heads)
    for model, channel, unit, numbers in judgement.list_rows():
        table.add_row(model, channel, unit, *(f"{number:.3g}" for number in numbers))
    console.print(table)
    count = len(judgement.windows.start)
    console.print(f"{count} windows; the 10 s before each prediction gave its delay and trim", "")


def show_replays(replays: Sequence[Replay]) -> None:
    """Print the distances of replays and set-points from the real flights."""
    console = terminal.make_console()
    table = terminal.make_table("recording", "distance to the real flight", "RMS", "max", "unit")
    for replay in replays:
        name = Path(replay.where).name
        for title, (rms, largest) in replay.list_rows():
            table.add_row(name, title, f"{rms:.3g}", f"{largest:.3g}", "m")
            name = ""
    console.print(table)
    for replay in replays:
        if replay.mean_command is not None:
            name = Path(replay.where).name
            console.print(f"{name}: mean motor command {replay.mean_command:.3f} of the maximum")
    console.print("")
