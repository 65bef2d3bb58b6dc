"""Files of fits and predictions: page, tables, and logs of measured and predicted motion."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from ..._core import Model, World
from ...model.obstacles import draw_world
from ...model.visuals import read_vehicle
from ...report.drawing import save_drawings
from ...simulation.log import Log
from ..flight_folder import (
    DOCUMENT,
    WrittenFlight,
    name_log,
    remove_flights,
    write_flights,
    write_logs,
)
from ..table import format_number, make_csv, save_files
from .fit import Fit
from .inputs import INPUTS
from .judgement import CONSTANT, DECISIVE, Judgement, make_logs
from .prepared import PreparedFlight
from .recorded import RecordedFit
from .replay import Replay
from .windows import HORIZONS

PAGE = "report.html"
ERRORS = "errors.csv"
FILES = (ERRORS, DOCUMENT, PAGE)
"""Files in the folder, in addition to logs, models and plots."""

_PLAYER_NOTE = "Each horizon starts from a measured state, with the fitted start of the horizon."
_OF_WINDOWS = (
    "First recording. Each prediction lasts 0.25 s, then the next one starts from the measured "
    "state."
)


def write_prediction(
    folder: Path,
    judgement: Judgement,
    flights: Sequence[PreparedFlight],
    model: Model,
    world: World,
    replays: Sequence[Replay] = (),
) -> List[Path]:
    """Write the errors and the page; with a pose, also the measured and predicted motion.

    Parameters
    ----------
    folder
        Existing folder.
    judgement
        Errors of the predictions.
    flights
        Predicted recordings.
    model, world
        Model and world of the predictions.
    replays
        Replays of the recordings. If there are any, the page animates the first one instead of the
        predictions.
    """
    written, images = _write_errors(folder, judgement)
    values = {**_describe_predictions(judgement, flights), "plots": images}
    count = len(judgement.windows.start)
    verdict = _compare_with_baselines(judgement)
    logs, note = make_logs(judgement), _OF_WINDOWS
    if replays:
        logs = [("measured", replays[0].measured), ("replayed", replays[0].flown)]
        note = f"First recording, and its set-points flown with {replays[0].controller}."
    values["replays"] = [
        {"recording": Path(replay.where).name, "title": title, "rms": rms, "max": largest}
        for replay in replays
        for title, (rms, largest) in replay.list_rows()
    ]
    return [
        *written,
        *_write_page(
            folder, "predict.html", logs, model, world, verdict=verdict, player_note=note,
            title=f"Prediction of real flights: {model.name}",
            conditions=f"{_name_recordings(flights)}; {count} predictions, engine eigen.", **values,
        ),
    ]  # fmt: skip


def write_recorded_fit(folder: Path, fit: RecordedFit, world: World) -> List[Path]:
    """Write the page of a fit to recordings, and the files of its judgement if there is one."""
    written: List[Path] = []
    values: Dict[str, Any] = {"predictions": [], "plots": [], "recordings": []}
    logs: List[Tuple[str, Log]] = []
    verdict = f"{_count(fit.found.values)} fitted to {len(fit.flights)} recordings."
    if fit.judgement is not None:
        written, images = _write_errors(folder, fit.judgement)
        values.update(_describe_predictions(fit.judgement, fit.judged), plots=images)
        logs = make_logs(fit.judgement)
        verdict = _compare_with_baselines(fit.judgement)
    values["recordings"] = _list_recordings([*fit.flights, *fit.judged])
    found = fit.found
    conditions = f"Fitted to {_name_recordings(fit.flights)}"
    if fit.judged:
        conditions += f"; judged on {_name_recordings(fit.judged)}"
    rows = _list_parameters(found.start, found.values, found.deviations, found.units)
    page = _write_page(
        folder, "fit.html", logs, fit.model, world, verdict=verdict, statements=fit.describe(),
        title=f"Fit of {fit.model.name}", conditions=f"{conditions}.", parameters=rows,
        residuals=[], player_note=_OF_WINDOWS, **values,
    )  # fmt: skip
    return [*written, *page]


def describe_residual(name: str, unit: str, values: Sequence[float]) -> str:
    """Describe how a fit changed a residual.

    Parameters
    ----------
    name, unit : str
        Quantity and its unit.
    values : sequence of float
        RMS residual with the start values, with the fitted values, and with the fitted values in
        the held-out parts (NaN without such parts).
    """
    before, after, held_out = values
    change = "reduces" if after < before else "does not reduce"
    verdict = (
        f"The fit {change} the RMS residual of the {name}: {format_number(before)} {unit} with the "
        f"start values, {format_number(after)} {unit} with the fitted values"
    )
    if math.isfinite(held_out):
        verdict += f", {format_number(held_out)} {unit} in the held-out parts"
    return verdict


def write_fit(folder: Path, found: Fit, world: World) -> List[Path]:
    """Write the page of a fit to a log of quadcore, with measured and simulated motion."""
    from .plots import draw_differences  # matplotlib is slow to import

    residuals = found.list_residuals()
    verdict = describe_residual(*residuals[0])
    rows = _list_parameters(found.start, found.values, found.identified.deviations, found.units)
    shown = [(each, unit, list(map(format_number, values))) for each, unit, values in residuals]
    images = draw_differences(found.motion) if found.motion else {}
    written = save_drawings(folder, images)
    conditions = f"Model {found.model.name}; {_count(found.values)}"
    if found.motion:
        time = found.motion[0][1].time
        conditions += f"; {time[-1] - time[0]:g} s of a log"
    page = _write_page(
        folder, "fit.html", found.motion, found.model, world, verdict=f"{verdict}.",
        statements=[f"{line[:1].upper()}{line[1:]}." for line in found.describe()],
        title=f"Fit of {found.model.name}", conditions=f"{conditions}.", parameters=rows,
        residuals=shown,
        player_note=_PLAYER_NOTE, predictions=[], recordings=[],
        plots=[{"name": name, "data": data} for name, data in images.items()],
    )  # fmt: skip
    return [*written, *page]


def write_rotor_factors(
    folder: Path, verdict: str, rows: Sequence[Mapping[str, str]], model: Model, world: World
) -> List[Path]:
    """Write the page with the thrust factors of damaged rotors; `rows` are its parameters."""
    return _write_page(
        folder, "fit.html", [], model, world, verdict=verdict, statements=[],
        title=f"Thrust of the rotors of {model.name}", parameters=rows, residuals=[],
        conditions=f"Model {model.name}; mean squared commands of the flights.",
        predictions=[], plots=[], recordings=[],
    )  # fmt: skip


def _write_page(
    folder: Path,
    template: str,
    logs: Sequence[Tuple[str, Log]],
    model: Model,
    world: World,
    **values: Any,
) -> List[Path]:
    """Write the logs, the model, ``run.json``, and the page with an animation of the logs."""
    from ...report.page import write_page  # jinja2 is slow to import
    from ...report.player import PlayerFlight, make_section

    remove_flights(folder)
    write_logs(folder, [log for _, log in logs])
    listed = [
        WrittenFlight(name, name_log(number), model, world)
        for number, (name, _) in enumerate(logs, start=1)
    ]
    written = write_flights(folder, listed)
    player = ""
    if logs:
        vehicle = read_vehicle(model)
        turning = [log.rotor_velocity.shape[1] == vehicle.rotor_count for _, log in logs]
        shown = [
            PlayerFlight(name, log, vehicle if turns else vehicle.fix_rotors())
            for (name, log), turns in zip(logs, turning)
        ]
        player = make_section(shown, draw_world(world))
    write_page(folder / PAGE, template, player=player, **values)
    return [*written, folder / PAGE]


def _write_errors(folder: Path, judgement: Judgement) -> Tuple[List[Path], List[Dict[str, Any]]]:
    from .plots import draw  # matplotlib is slow to import

    rows: List[List[Any]] = [["model", "channel", "unit", *(f"{h:g}s" for h in HORIZONS)]]
    for model, channel, unit, numbers in judgement.list_rows():
        rows.append([model, channel, unit, *map(repr, numbers)])
    images = draw(judgement)
    written = save_files(folder, {ERRORS: make_csv(rows)}) + save_drawings(folder, images)
    return written, [{"name": name, "data": data} for name, data in images.items()]


def _describe_predictions(
    judgement: Judgement, flights: Sequence[PreparedFlight]
) -> Dict[str, Any]:
    """Describe errors and recordings for the page, sorted by channel, then by model."""
    rows = judgement.list_rows()
    channels = list(dict.fromkeys(channel for _, channel, _, _ in rows))
    best = {
        channel: np.nanmin([numbers for _, each, _, numbers in rows if each == channel], axis=0)
        for channel in channels
    }
    ordered = sorted(rows, key=lambda row: channels.index(row[1]))
    return {
        "horizons": [f"{horizon:g} s" for horizon in HORIZONS],
        "predictions": [
            {
                "channel": channel,
                "unit": unit,
                "model": model,
                "cells": [
                    (f"{x:.3g}", bool(x == least)) for x, least in zip(numbers, best[channel])
                ],
            }
            for model, channel, unit, numbers in ordered
        ],
        "recordings": _list_recordings(flights),
    }


def _compare_with_baselines(judgement: Judgement) -> str:
    """Compare the errors of the judged model with those of the other models in one sentence."""
    place = HORIZONS.index(DECISIVE)
    rows = judgement.list_rows()
    channel, unit = rows[0][1:3]
    (first, found), *others = [
        (model, numbers[place]) for model, each, _, numbers in rows if each == channel
    ]
    parts = []
    for word, is_listed in (("better", True), ("worse", False)):
        listed = [
            f"{'' if model == CONSTANT else 'the '}{model} ({error:.3g} {unit})"
            for model, error in others
            if (found < error) == is_listed
        ]
        if listed:
            parts.append(f"{word} than {' and '.join(listed)}")
    return (
        f"The {first} predicts the {channel} {', but '.join(parts)}: RMS error {found:.3g} {unit} "
        f"after {DECISIVE:g} s."
    )


def _list_parameters(
    start: Mapping[str, float],
    values: Mapping[str, float],
    deviations: Mapping[str, float],
    units: Mapping[str, str],
) -> List[Dict[str, str]]:
    rows = []
    for name, deviation in deviations.items():
        spread = "not identifiable" if math.isnan(deviation) else f"{deviation:.2g}"
        if name in INPUTS and deviation == 0:
            spread = "fixed"
        numbers = {"start": f"{start[name]:.6g}", "value": f"{values[name]:.6g}"}
        rows.append({"name": name, **numbers, "deviation": spread, "unit": units[name]})
    return rows


def _list_recordings(flights: Sequence[PreparedFlight]) -> List[Dict[str, str]]:
    rows = []
    for flight in flights:
        aligned = [f"{topic} {1e3 * lag:.1f} ms" for topic, lag in flight.lags.items()]
        if flight.tilt:
            aligned.append(f"pose turned by {flight.tilt:.1f} deg to the IMU")
        left = [f"{r.topic}: {r.samples} samples, {r.reason}" for r in flight.removals]
        if len(flight.gaps):
            longest = float(np.max(flight.gaps[:, 1] - flight.gaps[:, 0]))
            left.append(f"{len(flight.gaps)} gaps, the longest {longest:.2f} s")
        span = f"{flight.span[1] - flight.span[0]:.1f} s"
        texts = {"aligned": "; ".join(aligned), "left_out": "; ".join(dict.fromkeys(left))}
        rows.append({"name": Path(flight.where).name, "span": span, **texts})
    return rows


def _name_recordings(flights: Sequence[PreparedFlight]) -> str:
    return ", ".join(Path(flight.where).name for flight in flights)


def _count(values: Mapping[str, Optional[float]]) -> str:
    return f"{len(values)} parameter{'s' if len(values) != 1 else ''}"
