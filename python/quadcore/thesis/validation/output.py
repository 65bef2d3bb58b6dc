"""Results of a study as tables, figures and a page."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Dict, Iterable, List, Mapping, Sequence

import numpy as np

from ..._core import InputError
from ...report.drawing import FORMATS, Drawing, save_drawings
from ...report.page import write_page
from ...studies.table import make_csv, make_json, save_files
from .animation import make_player, write_drawn_flights
from .error_budget import Chain
from .experiment import Case
from .states import STATES
from .study import Row, Study
from .thesis_figures import KINDS, thesis_figures

PICTURE = re.compile(rf"(commands|damping|(chain|{'|'.join(KINDS)})_[a-z]+)\.({'|'.join(FORMATS)})")
_SIZES = (*STATES, "distance")
_REPORTED = ("max", "rms")


def write_tables(study: Study, directory: Path) -> List[Path]:
    """Write all results to an existing folder; equal studies give bit-identical files.

    The function also writes flights for animations, but returns only the tables. It removes the
    figures of an earlier study in this folder.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    files = {
        "commands.csv": make_csv(_list_commands(study)),
        "errors.csv": make_csv(_list_errors(study.rows)),
        "chains.csv": make_csv(_list_chains(study.chains)),
        "validation.json": make_json(to_json(study)),
    }
    for old in directory.iterdir():
        if PICTURE.fullmatch(old.name):
            try:
                old.unlink()
            except OSError as error:
                raise InputError(f"{old}: cannot be removed: {error.strerror}") from error
    write_drawn_flights(study, directory)
    return save_files(directory, files)


def write_figure(name: str, picture: Drawing, directory: Path) -> None:
    """Write a figure listed by `figures.list_figures`.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    save_drawings(directory, {name: picture})


def write_report(study: Study, pictures: Mapping[str, Drawing], directory: Path) -> Path:
    """Write the report page.

    Parameters
    ----------
    pictures
        Drawings by the names of `figures.list_figures`; possibly empty.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    page = directory / "report.html"
    write_page(
        page,
        "validation.html",
        title=f"{study.experiment.asked['model']}: plant against mathematical model",
        study=study,
        rows={row.case: row for row in study.rows},
        Case=Case,
        pictures=pictures,
        kinds=KINDS,
        thesis_figures=thesis_figures,
        size=size,
        degrees=np.degrees,
        player=make_player(study) if pictures else "",
    )
    return page


def to_json(study: Study) -> Dict[str, Any]:
    """Return the results of a study as lists and dictionaries, with angles in rad."""
    experiment = study.experiment
    asked = dict(experiment.asked)
    spawn = asked.pop("spawn")
    shared = {
        **asked,
        "dt": experiment.plan.dt,
        "duration": experiment.plan.duration,
        "spawn": spawn,
        "motor_lag": experiment.motor_lag,
    }
    return {
        "experiment": shared,
        "commands": experiment.commands.tolist(),
        "errors": [_format_row(row) for row in study.rows],
        "chains": [
            {**chain._asdict(), "links": [_format_link(link) for link in chain.links]}
            for chain in study.chains
        ],
        "left_out": [_format_row(row) for row in study.left_out],
        "slowed": [_format_row(row) for row in study.slowed],
        "damping": [entry._asdict() for entry in study.damping],
        "thesis_figures": {
            f"{kind}_{drag}": thesis_figures(drag, kind, study.sim_slow)
            for drag in study.drags
            for kind in KINDS
        },
    }


def size(value: float) -> str:
    """Format a length with three significant digits, or one if it is small."""
    if value == 0:
        return "0"
    return f"{value:#.3g}".rstrip(".") if abs(value) >= 1e-3 else f"{value:.0e}"


def _format_row(row: Row) -> Dict[str, Any]:
    result = {**row.case._asdict(), "steepest": row.steepest, "failure": row.failure}
    if row.difference is not None:
        result.update({kind: getattr(row.difference, kind) for kind in _REPORTED})
    return result


def _format_link(link: Any) -> Dict[str, Any]:
    return {**link._asdict(), "begin": link.begin._asdict(), "end": link.end._asdict()}


def _list_commands(study: Study) -> Iterable[Sequence[Any]]:
    rows = study.experiment.commands.tolist()
    return [["t", *(f"w{i}" for i in range(1, len(rows[0])))], *rows]


def _list_errors(rows: Sequence[Row]) -> Iterable[Sequence[Any]]:
    kinds = [f"{kind}_{name}" for kind in ("max", "rms") for name in _SIZES]
    yield ["engine", "sim_slow", "drag", "steepest", *kinds, "failure"]
    for row in rows:
        sizes: Sequence[Any] = [""] * len(kinds)
        if row.difference is not None:
            parts = (getattr(row.difference, kind) for kind in _REPORTED)
            sizes = [part[name] for part in parts for name in _SIZES]
        yield [*row.case[:3], row.steepest, *sizes, row.failure]


def _list_chains(chains: Sequence[Chain]) -> Iterable[Sequence[Any]]:
    yield ["drag", "sim_slow", "change", "share", "max", "rms", "failure"]
    for chain in chains:
        for link in chain.links:
            yield [*chain[:2], link.change, link.share, link.max, link.rms, ""]
        yield [*chain[:2], "sum", chain.distance, "", "", chain.failure]
