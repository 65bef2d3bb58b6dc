"""``quadcore fit``: identify parameters of a model from a flight log."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Sequence

from .._core import InputError, engines, parse_number
from ..formats.recordings import is_recording
from ..model.description import read_world
from ..model.overrides import LINK_NAMES
from ..simulation.engines import STUDY_ENGINE
from ..studies.fit.record import CHANNELS
from ..studies.flight_folder import DOCUMENT
from ..studies.option_info import FLIGHT, OUTPUT, STUDY
from ..studies.output_folder import output_folder
from ..support import parse
from ..support.output_files import atomic_write, check_writable, encode_text
from . import options, reading, terminal
from .fit_recordings import DAMAGE, fit_damage, fit_real_flights, refuse_options
from .interrupted_output import keep_partial_output
from .parser import add_command, find_group
from .predict import add_force

if TYPE_CHECKING:
    from ..studies.fit.fit import Fit


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "fit",
        "Identify parameters of a model from logs of flights.",
        fit_model,
        """
        quadcore fit crazyflie --log a.csv --log b.csv --judge c.csv -o fitted.urdf
        quadcore fit quadrotor --log flight.csv --free frame.mass,drone_plugin.rotorThrustCoeff \\
          -o fitted.urdf
        """,
    )
    options.add_model(parser)
    study, output = find_group(parser, STUDY), find_group(parser, OUTPUT)
    study.add_argument(
        "--log",
        metavar="FILE",
        required=True,
        action="append",
        default=[],
        help="log of the flight, .csv, .mat or .bag, or a recording of a real flight; repeatable",
    )
    study.add_argument(
        "--judge",
        metavar="FILE",
        action="append",
        default=[],
        help="recording on which to judge the predictions of the fitted model; repeatable",
    )
    study.add_argument(
        "--sound",
        metavar="FILE",
        action="append",
        default=[],
        help="recording of the undamaged vehicle, for --free rotors.factor; repeatable",
    )
    add_force(parser)
    options.add_mapping(parser)
    study.add_argument(
        "--free",
        metavar="A,B",
        type=parse.names,
        help=f"parameters to identify: PLUGIN.TAG, {LINK_NAMES}, xacro.ARG, and "
        "for recordings inputs or rotors.factor (default for recordings: inertia, motors, drag, "
        "damping, inputs); start values come from the model, --set and --xacro",
    )
    study.add_argument(
        "--bound",
        metavar="NAME=LOW:HIGH",
        type=parse.assignment(r"([^=]+)=(.+)", "NAME=LOW:HIGH"),
        action="append",
        default=[],
        help="bounds of a free parameter; repeatable (default: non-negative parameters stay "
        "non-negative)",
    )
    options.add_commands(parser, " (default: topic vel_cmd of the log, else its rotor speeds)")
    study.add_argument(
        "--sensed",
        metavar="TOPIC",
        help="topic of the log with measured pose and velocities, such as odom (default: the "
        "state of the log)",
    )
    study.add_argument(
        "--channels",
        metavar="A,B",
        type=parse.several(list(CHANNELS)),
        help=f"channels to compare: {', '.join(CHANNELS)} (default: all but velocity)",
    )
    study.add_argument(
        "--horizon",
        metavar="S",
        type=parse.positive,
        help="length of the compared segments in seconds (default: 1)",
    )
    study.add_argument(
        "--shift",
        metavar="S",
        type=parse.not_negative,
        help="maximum delay of the measurements relative to the commands in seconds; the delay is "
        "identified too (default: 0)",
    )
    names = [name for name, _ in engines()]
    find_group(parser, FLIGHT).add_argument(
        "--engine", choices=names, default=STUDY_ENGINE, help=f"engine (default: {STUDY_ENGINE})"
    )
    options.add_options(parser, "world", "dt")
    output.add_argument("-o", metavar="FITTED.urdf", type=Path, help="model to write")
    output.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        help="folder for page, logs, errors of --judge and, without -o, the model; or, if it ends "
        "in .urdf, the model to write",
    )
    options.add_format(parser)
    options.add_quiet(parser)


def fit_model(arguments: argparse.Namespace) -> None:
    """Identify the parameters, print them, and write the model."""
    from ..studies.fit.output import FILES

    folder = arguments.out
    if folder is not None and folder.suffix.lower() == ".urdf":
        folder = None
    with output_folder(folder, FILES, DOCUMENT):
        out = _find_model_file(arguments, folder)
        is_real = arguments.mapping is not None or is_recording(Path(arguments.log[0]))
        if arguments.free == [DAMAGE]:
            fit_damage(arguments, out, folder)
        elif len(arguments.log) > 1 or arguments.judge or is_real:
            fit_real_flights(arguments, out, folder, _read_all_bounds(arguments))
        else:
            _fit_log(arguments, out, folder)


def _fit_log(arguments: argparse.Namespace, out: Path, folder: Optional[Path]) -> None:
    """Fit a model to a log of quadcore."""
    from ..studies.fit import fit
    from ..studies.fit.output import write_fit

    refuse_options(arguments, ("sound", "force"), "a fit of one log of quadcore")
    shared = reading.read_model_arguments(arguments)
    lengths = {name: getattr(arguments, name) for name in ("horizon", "shift")}
    shared.update((name, value) for name, value in lengths.items() if value is not None)

    def write_model(model: Any) -> None:
        with atomic_write(out) as stream:
            stream.write(encode_text(model.document.text))

    with keep_partial_output(
        "model", out, write_model, "best model so far"
    ), terminal.show_progress(arguments.quiet, "fitting") as progress:
        found = fit(
            shared.pop("model"),
            arguments.log[0],
            arguments.free or [],
            commands=arguments.commands,
            engine=arguments.engine,
            channels=arguments.channels,
            sensed=arguments.sensed,
            bounds=_read_all_bounds(arguments),
            world=arguments.world,
            dt=arguments.dt,
            progress=progress,
            **shared,
        )
    write_model(found.model)
    written = [out]
    if folder is not None:
        written += write_fit(folder, found, read_world(arguments.world, arguments.ignore))
    if not arguments.quiet:
        _show(found, written)


def _find_model_file(arguments: argparse.Namespace, folder: Optional[Path]) -> Path:
    """Return the path of the fitted model: -o, an --out that ends in .urdf, or a file in --out."""
    out: Optional[Path] = arguments.o
    if out is not None and arguments.out is not None and folder is None:
        raise InputError(f"-o {out}, --out {arguments.out}: name two models. Give one of them.")
    if out is None:
        out = arguments.out if folder is None else folder / "fitted.urdf"
    if out is None:
        raise InputError("the fitted model has no file. Name it with -o FITTED.urdf.")
    if out.suffix.lower() != ".urdf":
        raise InputError(f"{out}: is not a URDF file. Name a file that ends in .urdf.")
    check_writable(out)
    return out


def _read_all_bounds(arguments: argparse.Namespace) -> dict[str, tuple[float, float]]:
    return {name: _read_bounds(name, text) for name, text in arguments.bound}


def _read_bounds(name: str, text: str) -> tuple[float, float]:
    low, _, high = text.partition(":")
    minimum = parse_number(low) if low else -math.inf
    maximum = parse_number(high) if high else math.inf
    if minimum is None or maximum is None or ":" not in text:
        raise InputError(f"bound {name}: '{text}' is not a range. Write LOW:HIGH, LOW: or :HIGH.")
    return minimum, maximum


def _show(found: Fit, written: Sequence[Path]) -> None:
    console = terminal.make_console()
    table = terminal.make_table("parameter", "start", "identified", "std dev", "unit", numbers=True)
    for name, value in found.values.items():
        deviation = found.identified.deviations[name]
        spread = "not identifiable" if math.isnan(deviation) else f"{deviation:.2g}"
        table.add_row(name, f"{found.start[name]:.6g}", f"{value:.6g}", spread, found.units[name])
    console.print(table, "")
    for line in found.describe():
        console.print(line)
    table = terminal.make_table(
        "residual (RMS)", "start", "identified", "held out", "unit", numbers=True
    )
    for name, unit, numbers in found.list_residuals():
        table.add_row(name, *(f"{number:.4g}" for number in numbers), unit)
    console.print("", table)
    terminal.print_written(written)
