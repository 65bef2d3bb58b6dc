"""``quadcore fit``: parameters of a model from a flight log."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._core import InputError, engines, parse_number
from ..simulation.engines import STUDIED
from ..studies.fit.record import CHANNELS
from ..support import parse
from ..support.output_files import atomic_write, check_writable, text_bytes
from . import options, terminal
from .interrupted_output import keep_partial_output

if TYPE_CHECKING:
    from ..studies.fit.fit import Fit


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "fit", "Find parameters with which a model flies as a log says.", fit
    )
    options.add_model(parser)
    parser.add_argument(
        "--log", metavar="FILE", required=True, help="what was measured, .csv, .mat or .bag"
    )
    parser.add_argument(
        "--free",
        metavar="NAME,NAME",
        type=parse.names,
        required=True,
        help="what to find: PLUGIN.TAG, LINK.mass, LINK.ixx ... LINK.izz, xacro.ARG; --set and "
        "--xacro say from where",
    )
    parser.add_argument(
        "--bound",
        metavar="NAME=LOW:HIGH",
        type=parse.assignment(r"([^=]+)=(.+)", "NAME=LOW:HIGH"),
        action="append",
        default=[],
        help="between which a free number must stay (what is not negative stays so); repeatable",
    )
    options.add_commands(parser, " (topic vel_cmd of the log, or what its rotor speeds tell)")
    parser.add_argument(
        "--sensed",
        metavar="TOPIC",
        help="topic of the log with pose and velocities as they were measured: odom (the state)",
    )
    parser.add_argument(
        "--channels",
        metavar="A,B",
        type=parse.several(list(CHANNELS)),
        help=f"what is compared, of {', '.join(CHANNELS)} (all but velocity)",
    )
    parser.add_argument(
        "--horizon",
        metavar="S",
        type=parse.positive,
        default=1.0,
        help="length of a piece, s (1)",
    )
    parser.add_argument(
        "--shift",
        metavar="S",
        type=parse.not_negative,
        default=0.0,
        help="find by how much, at most, what was measured lags behind the commands, s (0)",
    )
    names = [name for name, _ in engines()]
    parser.add_argument("--engine", choices=names, default=STUDIED, help=f"what flies ({STUDIED})")
    options.add(parser, "world", "dt")
    parser.add_argument(
        "-o", "--out", metavar="FITTED.urdf", type=Path, required=True, help="the file to write"
    )
    options.add_quiet(parser)


def fit(arguments: argparse.Namespace) -> None:
    """Fit, print what the flight tells, and write the model."""
    from ..studies.fit import fit as search

    out = arguments.out
    if out.suffix.lower() != ".urdf":
        raise InputError(f"{out}: name a file that ends in .urdf, which it would hold")
    check_writable(out)
    shared = options.model_arguments(arguments)

    def put(model: Any) -> None:
        with atomic_write(out) as stream:
            stream.write(text_bytes(model.document.text))

    with keep_partial_output("model", out, put, "the best so far"), terminal.progress(
        arguments.quiet, "fitting"
    ) as progress:
        found = search(
            shared.pop("model"),
            arguments.log,
            arguments.free,
            commands=arguments.commands,
            engine=arguments.engine,
            horizon=arguments.horizon,
            channels=arguments.channels,
            sensed=arguments.sensed,
            bounds={name: _bounds(name, text) for name, text in arguments.bound},
            shift=arguments.shift,
            world=arguments.world,
            dt=arguments.dt,
            progress=progress,
            **shared,
        )
    put(found.model)
    if not arguments.quiet:
        _show(found, out)


def _bounds(name: str, text: str) -> tuple[float, float]:
    low, _, high = text.partition(":")
    least = parse_number(low) if low else -math.inf
    most = parse_number(high) if high else math.inf
    if least is None or most is None or ":" not in text:
        raise InputError(f"bound {name}: '{text}' is no range; write LOW:HIGH, or leave one out")
    return least, most


def _show(found: Fit, out: Path) -> None:
    console = terminal.console()
    table = terminal.table("free", "start", "found", "+-", "unit", numbers=True)
    for name, value in found.values.items():
        deviation = found.identified.deviations[name]
        told = "not told" if math.isnan(deviation) else f"{deviation:.2g}"
        table.add_row(name, f"{found.start[name]:.6g}", f"{value:.6g}", told, found.units[name])
    console.print(table, "")
    for line in found.describe():
        console.print(line)
    table = terminal.table("left over (rms)", "start", "found", "held out", "unit", numbers=True)
    for name, unit, numbers in found.list_residuals():
        table.add_row(name, *(f"{number:.4g}" for number in numbers), unit)
    console.print("", table)
    console.print(f"written {out}")
