"""The options that all studies share.

Each option is defined only here. Python functions take it as a keyword argument, commands as
``--FLAG``, and option files as ``FLAG: VALUE``. Help texts and docstrings are generated from it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import (
    Any,
    Callable,
    Dict,
    List,
    Mapping,
    Optional,
    Sequence,
    TypedDict,
    Union,
)

from .._core import InputError
from ..model import resources
from ..model.overrides import LINK_NAMES
from ..simulation.engines import STUDY_ENGINE
from ..simulation.scenarios import NONE
from ..support import arguments, parse
from ..support.values import SPAWN, Number, Value
from .criteria import CONSTRAINTS, METRICS, Criteria, Metric
from .option_info import (
    CONTROLLER,
    FLIGHT,
    OUTPUT,
    STUDY,
    VEHICLE,
    OptionInfo,
    describe_option,
    describe_options,
    list_kinds,
)
from .tracking_metrics import FAILURE_DISTANCE

Names = Union[str, Path, Sequence[Union[str, Path]]]
Progress = Callable[[int, int], None]

SPAWNED = "{:g},{:g},{:g}".format(*SPAWN)
"""Default start pose, in the format of ``--spawn``."""


@dataclass(frozen=True)
class Options:
    """Options of every study; each value is checked by itself.

    Raises
    ------
    InputError
        If the kind of a value is wrong.
    """

    parameters: Optional[Mapping[str, Value]] = field(default=None, metadata=describe_option(
        VEHICLE, "set", "PLUGIN.TAG=VALUE",
        f"value of a plugin tag, or of {LINK_NAMES}, xacro.ARG",
        parse.assignment(r"([^=]+\.[^.=]+)=(.+)", "PLUGIN.TAG=VALUE"),
        arguments.OPTIONS["parameters"], repeats=True,
    ))  # fmt: skip
    xacro_args: Optional[Mapping[str, object]] = field(default=None, metadata=describe_option(
        VEHICLE, "xacro", "ARG:=VALUE", "argument of the xacro file",
        parse.assignment(r"([^:=]+):=(.*)", "ARG:=VALUE"),
        arguments.OPTIONS["xacro_args"], repeats=True,
    ))  # fmt: skip
    ignore: Sequence[str] = field(default=(), metadata=describe_option(
        VEHICLE, "ignore", "NAME",
        "foreign plugin (name or file name), element, or model of the world to ignore",
        kind=arguments.OPTIONS["ignore"], repeats=True,
    ))  # fmt: skip
    world: Union[str, Path, None] = field(default=None, metadata=describe_option(
        VEHICLE, "world", "FILE",
        f"world file, or a built-in world: {', '.join(resources.list_shipped('worlds'))}",
        kind=arguments.ANY, without="empty",
    ))  # fmt: skip
    at: Optional[Sequence[float]] = field(default=None, metadata=describe_option(
        VEHICLE, "at", "LAT,LON[,ALT]",
        "place on Earth of the world's origin in degrees and m, which sets gravity, magnetic field "
        "and the origin of GPS receivers", parse.location,
        arguments.or_none(arguments.PLACE), "that of the world",
    ))  # fmt: skip
    dt: Optional[float] = field(default=None, metadata=describe_option(
        FLIGHT, "dt", "S", "step in seconds", parse.positive,
        arguments.OPTIONS["dt"], "the world's",
    ))  # fmt: skip
    scenario: Optional[Names] = field(default=None, metadata=describe_option(
        FLIGHT, "scenario", "A,B",
        "scenario files or built-in scenarios of disturbances and faults: "
        + ", ".join([NONE, *resources.list_shipped("config/scenarios")]),
        parse.names, without=NONE,
    ))  # fmt: skip
    wind: Optional[Sequence[float]] = field(default=None, metadata=describe_option(
        FLIGHT, "wind", "X,Y,Z", "constant wind in m/s, world axes", parse.vector,
        arguments.or_none(arguments.VECTOR), "that of the world, model and scenario",
    ))  # fmt: skip
    seed: int = field(
        default=0,
        metadata=describe_option(
            FLIGHT, "seed", "N", "first seed of the noise", parse.integer(0, 2**64 - 1)
        ),
    )
    seeds: int = field(default=1, metadata=describe_option(
        STUDY, "seeds", "N", "number of consecutive seeds", parse.integer(1), arguments.COUNT,
    ))  # fmt: skip
    duration: float = field(
        default=10.0,
        metadata=describe_option(
            FLIGHT, "duration", "S", "simulated time in seconds", parse.positive, arguments.SECONDS
        ),
    )
    spawn: Optional[Sequence[Number]] = field(default=None, metadata=describe_option(
        FLIGHT, "spawn", "X,Y,Z[,ROLL,PITCH,YAW]", "start pose of the frame link in m and rad",
        parse.pose, without="on the reference",
    ))  # fmt: skip
    log_every: Optional[int] = field(default=None, metadata=describe_option(
        OUTPUT, "log-every", "N", "steps per logged and evaluated row",
        parse.integer(1), without="one row per 0.01 s",
    ))  # fmt: skip
    controller_rate: Optional[float] = field(default=None, metadata=describe_option(
        CONTROLLER, "controller-rate", "HZ", "controller calls per simulated second",
        parse.positive, without="the controller's, else 500",
    ))  # fmt: skip
    delay: Optional[float] = field(default=None, metadata=describe_option(
        CONTROLLER, "delay", "S", "actuation delay in seconds", parse.not_negative,
        without="the controller's, else 0",
    ))  # fmt: skip
    time_limit: float = field(default=300.0, metadata=describe_option(
        STUDY, "time-limit", "S", "wall-clock limit per flight in seconds",
        parse.positive, arguments.LIMIT,
    ))  # fmt: skip
    processes: Optional[int] = field(default=None, metadata=describe_option(
        STUDY, "jobs", "N", "number of processes", parse.integer(1),
        arguments.or_none(arguments.COUNT), "one per core",
    ))  # fmt: skip
    progress: Optional[Progress] = field(default=None, metadata=describe_option(
        STUDY, "", "", "function called as progress(done, total)",
        kind=arguments.or_none(arguments.PROGRESS), without="none",
    ))  # fmt: skip

    def __post_init__(self) -> None:
        """Check each value."""
        arguments.check(vars(self), list_kinds(type(self)))


class Keywords(TypedDict, total=False):
    """`Options` as keyword arguments for type checkers; a test compares both."""

    parameters: Optional[Mapping[str, Value]]
    xacro_args: Optional[Mapping[str, object]]
    ignore: Sequence[str]
    world: Union[str, Path, None]
    at: Optional[Sequence[float]]
    dt: Optional[float]
    scenario: Optional[Names]
    wind: Optional[Sequence[float]]
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
    """Describe an option again, with some parts replaced."""
    return {"about": describe_options(Options)[name]._replace(**parts)}


@dataclass(frozen=True)
class ControlOptions(Options):
    """Options of studies that judge controllers."""

    privileged: bool = field(default=False, metadata=describe_option(
        CONTROLLER, "privileged", "",
        "give your own controllers the whole simulation instead of a view of the vehicle; "
        "the results mark them",
        kind=arguments.FLAG, without="false",
    ))  # fmt: skip
    failure_distance: float = field(default=FAILURE_DISTANCE, metadata=describe_option(
        STUDY, "failure-distance", "M", "tracking error in m at which a flight has failed",
        parse.positive, arguments.DISTANCE,
    ))  # fmt: skip


class ControlKeywords(Keywords, total=False):
    """`ControlOptions` as keyword arguments for type checkers."""

    privileged: bool
    failure_distance: float


@dataclass(frozen=True)
class CriteriaOptions(ControlOptions):
    """Options of studies that measure flights."""

    constraints: Optional[Mapping[str, Any]] = field(default=None, metadata=describe_option(
        STUDY, "constraint", "NAME=LIMIT",
        f"measure the time in violation of a constraint: {', '.join(CONSTRAINTS)}; geofence "
        "takes XMIN,YMIN,ZMIN,XMAX,YMAX,ZMAX",
        parse.assignment(r"([^=]+)=(.+)", "NAME=LIMIT"),
        arguments.or_none(arguments.NAMED), repeats=True,
    ))  # fmt: skip
    metrics: Sequence[Metric] = field(default=(), metadata=describe_option(
        STUDY, "metric", "NAME",
        f"further metric: {', '.join(METRICS)}; or your function of the log, FILE.py:NAME or "
        "MODULE:NAME",
        kind=arguments.METRICS, repeats=True,
    ))  # fmt: skip

    def make_criteria(self) -> Criteria:
        """Return the criteria; raise `InputError` if a constraint or metric is invalid."""
        return Criteria.make(self.failure_distance, self.constraints, self.metrics)


class CriteriaKeywords(ControlKeywords, total=False):
    """`CriteriaOptions` as keyword arguments for type checkers."""

    constraints: Optional[Mapping[str, Any]]
    metrics: Sequence[Metric]


@dataclass(frozen=True)
class EvaluateOptions(CriteriaOptions):
    """Options of `evaluate`."""

    duration: float = field(default=30.0, metadata=change_option("duration"))
    computation_time: Union[float, str, None] = field(default=None, metadata=describe_option(
        CONTROLLER, "computation-time", "S|measured",
        "delay each command also by the computation time of its controller: in seconds, or as "
        "measured on this machine",
        parse.computation_time, arguments.COMPUTATION_TIME, "none",
    ))  # fmt: skip
    spectra: bool = field(default=False, metadata=describe_option(
        STUDY, "spectra", "",
        "also draw the power spectral densities of angular velocities and commands",
        kind=arguments.FLAG, without="false",
    ))  # fmt: skip
    frequency_response: bool = field(default=False, metadata=describe_option(
        STUDY, "frequency-response", "",
        "also measure the frequency responses of the loops in hover",
        kind=arguments.FLAG, without="false",
    ))  # fmt: skip


class EvaluateKeywords(CriteriaKeywords, total=False):
    """`EvaluateOptions` as keyword arguments for type checkers."""

    computation_time: Union[float, str, None]
    spectra: bool
    frequency_response: bool


@dataclass(frozen=True)
class MeasureOptions(CriteriaOptions):
    """Options of `measure`."""

    duration: Optional[float] = field(  # type: ignore[assignment]
        default=None,
        metadata=change_option(
            "duration",
            meaning="time after which rows of the logs are left out, in seconds",
            kind=arguments.or_none(arguments.SECONDS),
            without="that of the longest log",
        ),
    )


@dataclass(frozen=True)
class CompareOptions(Options):
    """Options of `compare`."""

    log_every: Optional[int] = field(
        default=1, metadata=change_option("log_every", kind=arguments.COUNT, without="")
    )
    spawn: Optional[Sequence[Number]] = field(
        default=None, metadata=change_option("spawn", without=f"{SPAWNED}, or on the reference")
    )


@dataclass(frozen=True)
class SweepOptions(CriteriaOptions):
    """Options of `sweep`."""

    spawn: Optional[Sequence[Number]] = field(
        default=None,
        metadata=change_option("spawn", without=f"on the reference, or {SPAWNED} with --commands"),
    )


def choose_engines(engine: Optional[str], engines: Union[str, Sequence[str]]) -> List[str]:
    """List the engines of a study that accepts `engine` instead of `engines`."""
    if engine is None:
        return arguments.to_list(engines)
    if engines != STUDY_ENGINE:
        raise InputError("engine and engines are both given. Keep one.")
    return [engine]
