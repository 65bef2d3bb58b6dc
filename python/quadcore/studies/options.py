"""The options that all studies share.

Each option is defined here once. The Python functions take it as a keyword argument, the commands
as ``--FLAG``, and files of options as ``FLAG: VALUE``; `--help` and docstrings are made of it.
"""

from __future__ import annotations

import functools
import inspect
import textwrap
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import (
    Any,
    Callable,
    Dict,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Type,
    TypedDict,
    TypeVar,
    Union,
    get_type_hints,
)

from .._core import InputError
from ..model import resources
from ..simulation.engines import STUDIED
from ..simulation.scenarios import NONE
from ..support import arguments, parse
from ..support.arguments import Kind
from ..support.values import SPAWN, Number, Value

Names = Union[str, Path, Sequence[Union[str, Path]]]
Progress = Callable[[int, int], None]
Function = TypeVar("Function", bound=Callable[..., Any])

SPAWNED = "{:g},{:g},{:g}".format(*SPAWN)
"""Where a flight begins by default, as --spawn takes it."""


class OptionInfo(NamedTuple):
    """How an option is written, read, checked and explained."""

    flag: str
    """Name on the command line; "" for an option of the Python functions only."""
    metavar: str
    meaning: str
    read: Callable[[str], Any]
    """Reader of the command line's text."""
    kind: Kind
    without: str
    """Effect of leaving the option out, "" if the default value says it."""
    repeats: bool


def _describe(
    flag: str,
    metavar: str,
    meaning: str,
    read: Callable[[str], Any] = str,
    kind: Kind = arguments.ANY,
    without: str = "",
    repeats: bool = False,
) -> Dict[str, OptionInfo]:
    return {"about": OptionInfo(flag, metavar, meaning, read, kind, without, repeats)}


@dataclass(frozen=True)
class Options:
    """Options of every study, checked one by one.

    Raises
    ------
    InputError
        If a value is of another kind than its option's.
    """

    parameters: Optional[Mapping[str, Value]] = field(default=None, metadata=_describe(
        "set", "PLUGIN.TAG=VALUE",
        "other values of plugin tags, or of LINK.mass, LINK.ixx ... LINK.izz, xacro.ARG",
        parse.assignment(r"([^=]+\.[^.=]+)=(.+)", "PLUGIN.TAG=VALUE"),
        arguments.OPTIONS["parameters"], repeats=True,
    ))  # fmt: skip
    xacro_args: Optional[Mapping[str, object]] = field(default=None, metadata=_describe(
        "xacro", "ARG:=VALUE", "arguments of the xacro file",
        parse.assignment(r"([^:=]+):=(.*)", "ARG:=VALUE"),
        arguments.OPTIONS["xacro_args"], repeats=True,
    ))  # fmt: skip
    ignore: Sequence[str] = field(default=(), metadata=_describe(
        "ignore", "NAME",
        "foreign plugins (name or file name), elements, or models of the world to leave out",
        kind=arguments.OPTIONS["ignore"], repeats=True,
    ))  # fmt: skip
    world: Union[str, Path, None] = field(default=None, metadata=_describe(
        "world", "FILE",
        f"world file, or a shipped world: {', '.join(resources.shipped('worlds'))}",
        kind=arguments.ANY, without="empty",
    ))  # fmt: skip
    dt: Optional[float] = field(default=None, metadata=_describe(
        "dt", "S", "step in s", parse.positive,
        arguments.OPTIONS["dt"], "the world's",
    ))  # fmt: skip
    scenario: Optional[Names] = field(default=None, metadata=_describe(
        "scenario", "A,B",
        "disturbances and faults, files or shipped: "
        + ", ".join([NONE, *resources.shipped("config/scenarios")]),
        parse.names, without=NONE,
    ))  # fmt: skip
    seed: int = field(
        default=0,
        metadata=_describe("seed", "N", "first seed of all noise", parse.integer(0, 2**64 - 1)),
    )
    seeds: int = field(default=1, metadata=_describe(
        "seeds", "N", "number of seeds, counted from the first on",
        parse.integer(1), arguments.COUNT,
    ))  # fmt: skip
    duration: float = field(
        default=10.0,
        metadata=_describe("duration", "S", "time to fly in s", parse.positive, arguments.SECONDS),
    )
    spawn: Optional[Sequence[Number]] = field(default=None, metadata=_describe(
        "spawn", "X,Y,Z[,ROLL,PITCH,YAW]", "start pose of the frame in m and rad",
        parse.pose, without="on the reference",
    ))  # fmt: skip
    log_every: Optional[int] = field(default=None, metadata=_describe(
        "log-every", "N", "steps from one logged or measured row to the next",
        parse.integer(1), without="each hundredth of a second",
    ))  # fmt: skip
    controller_rate: Optional[float] = field(default=None, metadata=_describe(
        "controller-rate", "HZ", "calls of the controller per second",
        parse.positive, without="the controller's, else 500",
    ))  # fmt: skip
    delay: Optional[float] = field(default=None, metadata=_describe(
        "delay", "S", "actuation delay in s", parse.not_negative,
        without="the controller's, else 0",
    ))  # fmt: skip
    time_limit: float = field(default=300.0, metadata=_describe(
        "time-limit", "S", "limit of the wall clock for one flight in s",
        parse.positive, arguments.LIMIT,
    ))  # fmt: skip
    processes: Optional[int] = field(default=None, metadata=_describe(
        "jobs", "N", "processes", parse.integer(1),
        arguments.or_none(arguments.COUNT), "one per core",
    ))  # fmt: skip
    progress: Optional[Progress] = field(default=None, metadata=_describe(
        "", "", "function that is called as progress(done, total)",
        kind=arguments.or_none(arguments.PROGRESS), without="none",
    ))  # fmt: skip

    def __post_init__(self) -> None:
        """Check each value."""
        arguments.check(vars(self), list_kinds(type(self)))


class Keywords(TypedDict, total=False):
    """`Options` as keyword arguments, for type checkers; a test compares the two."""

    parameters: Optional[Mapping[str, Value]]
    xacro_args: Optional[Mapping[str, object]]
    ignore: Sequence[str]
    world: Union[str, Path, None]
    dt: Optional[float]
    scenario: Optional[Names]
    seed: int
    seeds: int
    duration: float
    spawn: Optional[Sequence[Number]]
    log_every: Optional[int]
    controller_rate: Optional[float]
    delay: Optional[float]
    time_limit: float
    processes: Optional[int]
    progress: Optional[Progress]


def change_option(name: str, **parts: Any) -> Dict[str, OptionInfo]:
    """Describe an option again, some parts otherwise."""
    return {"about": describe_options(Options)[name]._replace(**parts)}


def describe_options(kind: Type[Options]) -> Dict[str, OptionInfo]:
    """Give the description of each option, by name."""
    return {each.name: each.metadata["about"] for each in fields(kind)}


@dataclass(frozen=True)
class EvaluateOptions(Options):
    """Options of `evaluate`."""

    duration: float = field(default=30.0, metadata=change_option("duration"))


@dataclass(frozen=True)
class CompareOptions(Options):
    """Options of `compare`."""

    log_every: Optional[int] = field(
        default=1, metadata=change_option("log_every", kind=arguments.COUNT, without="")
    )
    spawn: Optional[Sequence[Number]] = field(
        default=None,
        metadata=change_option("spawn", without=f"{SPAWNED}; with a reference, on that"),
    )


@dataclass(frozen=True)
class SweepOptions(Options):
    """Options of `sweep`."""

    spawn: Optional[Sequence[Number]] = field(
        default=None,
        metadata=change_option("spawn", without=f"on the reference; with --commands {SPAWNED}"),
    )


def choose_engines(engine: Optional[str], engines: Union[str, Sequence[str], None]) -> List[str]:
    """List the engines of a study, which takes `engine` for one and `engines` for several."""
    if engine is not None and engines is not None:
        raise InputError("engine and engines are both given. Keep one.")
    if engine is not None:
        return [engine]
    return arguments.several(STUDIED if engines is None else engines)


def list_kinds(kind: Type[Options]) -> Dict[str, Kind]:
    """Give the kind of each option's value, by name."""
    return {name: about.kind for name, about in describe_options(kind).items()}


def explain(about: OptionInfo, default: Any) -> str:
    """Write meaning and default of an option in one line."""
    plain = f"{default:g}" if isinstance(default, float) else str(default)
    without = about.without or ("" if default in (None, ()) else plain)
    return f"{about.meaning} ({without})" if without else about.meaning


def accept_options(kind: Type[Options], **own: Kind) -> Callable[[Function], Function]:
    """Let a function take options as ``**options``, shown by its signature and docstring.

    Parameters
    ----------
    kind
        The options.
    **own
        Kinds of other arguments; all are checked before the function is called.
    """

    def decorate(function: Function) -> Function:
        signature, hints = inspect.signature(function), get_type_hints(kind)
        *named, rest = signature.parameters.values()
        known = {**{each.name: arguments.ANY for each in named}, **own, **list_kinds(kind)}

        @functools.wraps(function)
        def call(*values: Any, **given: Any) -> Any:
            bound = signature.bind(*values, **given)
            read = {name: arguments.read_once(value) for name, value in bound.arguments.items()}
            bound.arguments.update(read)
            arguments.check({**read.pop(rest.name, {}), **read}, known)
            return function(*bound.args, **bound.kwargs)

        options = [
            inspect.Parameter(
                each.name,
                inspect.Parameter.KEYWORD_ONLY,
                default=each.default,
                annotation=hints[each.name],
            )
            for each in fields(kind)
        ]
        call.__signature__ = signature.replace(parameters=[*named, *options])  # type: ignore[attr-defined]
        call.__doc__ = (function.__doc__ or "").replace("    **options\n", _document_options(kind))
        return call  # type: ignore[return-value]

    return decorate


def _document_options(kind: Type[Options]) -> str:
    """Write the options as a docstring's parameters."""
    lines = []
    for each in fields(kind):
        meaning = explain(each.metadata["about"], each.default)
        told = textwrap.fill(f"{meaning[0].upper()}{meaning[1:]}.", 88)
        lines.append(f"    {each.name}\n{textwrap.indent(told, ' ' * 8)}\n")
    return "".join(lines)
