"""``quadcore evaluate``: how well controllers fly."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from .. import interrupts, laws, references
from .._core import FlightError, InputError
from ..files import check_writable, make_folder, read_text
from ..plants import plants
from . import options, terminal, values

if TYPE_CHECKING:
    from ..evaluation.evaluate import Evaluation
    from ..evaluation.plan import Plan

_ROWS = 40  # on the terminal


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "evaluate", "Fly controllers along references, and measure them.", evaluate
    )
    parser.add_argument(
        "file", metavar="FILE.yaml", nargs="?", help="options by name; those given besides win"
    )
    parser.add_argument(
        "--controller",
        metavar="A,B",
        type=values.several_calls,
        help=f"{', '.join(laws.NAMES)}, perhaps with parameters, LAW:KEY=VALUE,...; files of "
        "gains; MODULE:CLASS",
    )
    parser.add_argument(
        "--reference",
        metavar="A,B",
        type=values.several_calls,
        help=f"{', '.join(references.NAMES)}, NAME:KEY=VALUE,..., or files",
    )
    parser.add_argument(
        "--model", metavar="A,B", type=values.names, default=["quadrotor"], help="(quadrotor)"
    )
    options.add_changes(parser)
    parser.add_argument(
        "--seeds", metavar="N", type=values.integer(1), default=1, help="from --seed on (1)"
    )
    options.add_vary(parser, " and controller.KEY, its rate, delay or a parameter of the laws")
    options.add_flight(parser, several_engines=True, log_every=None, flown=plants(), seconds=30.0)
    options.add_timing(parser)
    parser.add_argument(
        "--margins", action="store_true", help="search for gain and delay margins, too"
    )
    parser.add_argument(
        "--time-limit",
        metavar="S",
        type=values.positive,
        default=300.0,
        help="of the wall clock for one flight, s (300)",
    )
    options.add_jobs(parser)
    parser.add_argument(
        "--out", metavar="DIR", type=Path, help="write tables, pictures and a page here"
    )
    parser.add_argument("--no-plots", action="store_true", help="no pictures in --out")
    parser.set_defaults(engine=["eigen"], parser=parser)


def evaluate(arguments: argparse.Namespace) -> None:
    """Fly everything, print how well, and write it."""
    from ..evaluation.evaluate import conduct
    from ..evaluation.output import write

    if arguments.file is not None:
        arguments = _with_file(arguments)
    plan = _plan(arguments)
    out = arguments.out
    if out is not None:
        make_folder(out)
        check_writable(out / "report.html")  # after the flights would be too late
    try:
        with terminal.progress(arguments.quiet) as progress:
            evaluation = conduct(
                plan, arguments.time_limit, arguments.jobs, progress, arguments.margins
            )
    except KeyboardInterrupt as stop:
        partial = getattr(stop, "evaluation", None)
        if out is not None and partial is not None:
            with interrupts.held():
                write(partial, plan, _flight(arguments), out, plots=False)
            terminal.say(f"what was flown: {out}")
        raise
    files = []
    if out is not None:
        files = write(evaluation, plan, _flight(arguments), out, not arguments.no_plots)
    if not arguments.quiet:
        _show(evaluation, files)
    _report_failures(evaluation)


def _plan(arguments: argparse.Namespace) -> Plan:
    from ..evaluation.plan import Plan

    for name in ("controller", "reference"):
        if getattr(arguments, name) is None:
            raise InputError(f"nothing to fly: name --{name}")
    shared = {**options.model_arguments(arguments), **options.flight_arguments(arguments)}
    for name in ("model", "engine", "spawn"):  # of which there are several, or none
        shared.pop(name)
    return Plan(
        arguments.controller,
        arguments.reference,
        arguments.engine,
        arguments.model,
        arguments.seeds,
        options.varied(arguments),
        arguments.duration,
        arguments.log_every,
        arguments.spawn,
        arguments.controller_rate,
        arguments.delay,
        shared,
    )


def _with_file(arguments: argparse.Namespace) -> argparse.Namespace:
    """Read the options of a file as if they stood before those of the command line."""
    path = Path(arguments.file)
    words = []
    for key, value, line in _entries(path):
        option = f"--{key}"
        if option not in arguments.parser._option_string_actions or key == "help":
            raise InputError(f"{path}:{line}: there is no option '{key}'; see quadcore evaluate -h")
        try:
            words += _words(option, value)
        except TypeError:
            raise InputError(
                f"{path}:{line}: {key} is {value!r}; write a value, a list, or true"
            ) from None
    try:
        again: argparse.Namespace = arguments.parser.parse_args([*words, *arguments.words[1:]])
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    return again


def _entries(path: Path) -> list[tuple[str, Any, int]]:
    """Keys, values and lines of a mapping."""
    text = read_text(path)
    try:
        node = yaml.compose(text, yaml.SafeLoader)
        read = yaml.safe_load(text)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = mark.line + 1 if mark else 1
        problem = getattr(error, "problem", None) or "not YAML"
        raise InputError(f"{path}:{line}: {problem}") from None
    if not isinstance(node, yaml.MappingNode):
        raise InputError(f"{path}:1: write options as KEY: VALUE")
    entries: list[tuple[str, Any, int]] = []
    for key, _ in node.value:
        name, line = str(key.value), key.start_mark.line + 1
        if name in [entry[0] for entry in entries]:
            raise InputError(f"{path}:{line}: {name} is given twice; keep one")
        entries.append((name, read[name], line))
    return entries


def _words(option: str, value: Any) -> list[str]:
    """Write an option as a command line does."""
    if value is True:
        return [option]
    if value is False or value is None:
        return []
    if isinstance(value, dict):  # --set, --vary: repeated; --xacro: with another sign
        sign = ":=" if option == "--xacro" else "="
        return [w for k, v in value.items() for w in (option, f"{k}{sign}{_text(v)}")]
    return [f"{option}={_text(value)}"]


def _text(value: Any) -> str:
    if isinstance(value, list):
        return ",".join(map(_text, value))
    if isinstance(value, bool):
        return str(value).lower()
    if not isinstance(value, (str, int, float)):
        raise TypeError(value)
    return str(value)


def _flight(arguments: argparse.Namespace) -> dict[str, str]:
    """Describe what all flights share."""
    return {
        "controllers": ", ".join(arguments.controller),
        "references": ", ".join(arguments.reference),
        "engines": ", ".join(arguments.engine),
        "models": ", ".join(arguments.model),
        "duration": f"{arguments.duration:g} s",
        "seeds": f"{arguments.seeds}, from {arguments.seed} on",
        "begins": "on the reference" if arguments.spawn is None else str(arguments.spawn),
        **{f"vary {key}": value for key, value in arguments.vary},
        **options.changes_told(arguments),
    }


def _show(evaluation: Evaluation, files: list[Path]) -> None:
    from ..evaluation.output import rows_to_read, summary

    console = terminal.console()
    lines = rows_to_read(evaluation)
    shown = {
        name: heading
        for name, heading in (
            ("controller", "controller"),
            ("reference", "reference"),
            ("engine", "engine"),
            ("model", "model"),
            ("scenario", "scenario"),
        )
        if name == "controller" or len({line[name] for line in lines}) > 1
    }
    shown.update(flown="flown", rms_position="RMS (m)", largest_position="largest (m)")
    shown.update(tail_position="last 10 s (m)", cvar="its CVaR (m)")
    if any(line["difference"] for line in lines):
        shown["difference"] = "from the first (m)"
    table = terminal.table(*shown.values(), "")
    for line in lines[:_ROWS]:
        table.add_row(*(line[name] for name in shown), line["best"])
    console.print(table)
    if evaluation.margins:
        console.print("", _margins(evaluation))
    if len(lines) > _ROWS:
        console.print(f"{len(lines) - _ROWS} more combinations")
    console.print(summary(evaluation))
    for file in files:
        console.print(f"written {file}")


def _margins(evaluation: Evaluation) -> Any:
    from ..evaluation.output import error_text

    table = terminal.table("controller", "gain", "delay (s)", "box, median / worst (m)")
    for row in evaluation.margins:
        if row["failure"]:
            table.add_row(row["controller"], row["failure"])
            continue
        gain, box = (
            " / ".join(error_text(row[name]) or "-" for name in names)
            for names in (("gain_low", "gain_high"), ("box_median", "box_worst"))
        )
        table.add_row(row["controller"], gain, error_text(row["delay_margin"]) or "-", box)
    return table


def _report_failures(evaluation: Evaluation) -> None:
    failed = [row for row in evaluation.table if row["failure"]]
    if failed:
        first = failed[0]
        raise FlightError(
            f"{len(failed)} of {len(evaluation.table)} flights failed; the first, "
            f"{first['controller']} on {first['reference']} in {first['engine']}, seed "
            f"{first['seed']}: {first['failure']}"
        )
