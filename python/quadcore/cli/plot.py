"""``quadcore plot``: plot logs."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, List, Sequence

from ..report.decimation import decimate
from ..report.drawing import save_drawings
from ..simulation.log import Log
from ..studies.figures import draw_figures
from ..studies.option_info import OUTPUT
from ..support.output_files import make_folder
from . import options, terminal
from .parser import add_command, find_group
from .played_flights import add_logs, find_flights

_OUT = Path("out/plot")
_ROWS = 20_000  # maximum number of rows of each of several logs; a plot cannot show more


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "plot",
        "Plot a log, or several logs in the same axes with their differences from the first.",
        plot_logs,
        """
        quadcore plot out/hover
        quadcore plot a.csv b.csv --names before,after --out out/both
        """,
    )
    add_logs(parser)
    find_group(parser, OUTPUT).add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        default=_OUT,
        help=f"folder for the plots (default: {_OUT})",
    )
    options.add_format(parser)
    options.add_quiet(parser)


def plot_logs(arguments: argparse.Namespace) -> None:
    """Read the logs, and write the plots."""
    played = find_flights(arguments)
    names = [flight.name for flight in played]
    logs = [Log.of_file(flight.log, arguments.mapping) for flight in played]
    if len(logs) == 1:
        logs[0].title = names[0]
        written = logs[0].plot(arguments.out)
    else:
        written = _plot_together(names, logs, arguments.out)
    if not arguments.quiet:
        terminal.print_written(written)


def _plot_together(names: Sequence[str], logs: Sequence[Log], folder: Path) -> List[Path]:
    from ..studies.compare.plots import Curve, list_figures  # matplotlib is slow to import

    curves = [Curve(name, decimate(log, _ROWS)) for name, log in zip(names, logs)]
    figures = list_figures(curves, curves[0].log, names[0])
    make_folder(folder)
    return save_drawings(folder, draw_figures(figures, is_on_page=False))
