"""``quadcore plot``: pictures of logs that there are."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, List, Sequence

from ..report.decimation import decimate
from ..simulation.log import Log
from ..studies.table import save_files
from ..support.output_files import make_folder
from . import options, terminal
from .play import add_names, names_of

_OUT = Path("out/plot")
_ROWS = 20_000  # of several logs, more than a picture shows


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "plot", "Draw a log, or several over each other, from the first on.", plot
    )
    parser.add_argument("logs", metavar="LOG", nargs="+", type=Path, help="log, .csv, .mat or .bag")
    parser.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        default=_OUT,
        help=f"write pictures here; made if missing ({_OUT})",
    )
    add_names(parser)
    parser.add_argument("--quiet", action="store_true", help="print warnings and errors only")


def plot(arguments: argparse.Namespace) -> None:
    """Read the logs and draw them."""
    names = names_of(arguments)
    logs = [Log.of_file(file) for file in arguments.logs]
    if len(logs) == 1:
        logs[0].title = names[0]
        written = logs[0].plot(arguments.out)
    else:
        written = _over_each_other(names, logs, arguments.out)
    if not arguments.quiet:
        for file in written:
            terminal.console().print(f"written {file}")


def _over_each_other(names: Sequence[str], logs: Sequence[Log], folder: Path) -> List[Path]:
    from ..report.plots import png
    from ..studies.compare.plots import Curve, draw  # matplotlib is slow to import

    curves = [Curve(name, decimate(log, _ROWS)) for name, log in zip(names, logs)]
    figures = draw(curves, curves[0].log, names[0])
    make_folder(folder)
    return save_files(folder, {f"{name}.png": png(figure) for name, figure in figures.items()})
