"""Built-in controllers.

Each function makes a controller, for example ``quadcore.controllers.geometric(kp_xy=4)``. Its
docstring lists the parameters. ``NAMES`` contains all names, and ``FIRMWARE`` the names of
controllers with the gains of a firmware. `read_controller` reads a gains file.
"""

from __future__ import annotations

from typing import (
    TYPE_CHECKING,
    Any,
    Callable,
    Dict,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Tuple,
)

from .. import _core
from ..support.parameters import make_signature, read_values, suggest, write_docstring
from ..support.user_code import find_controller, names_file, split_name
from ..support.warning import warn
from . import gains
from .built_in import BuiltInController
from .controller import set_parameter
from .gains import Gains, make_for_vehicle, read_controller
from .keywords import ControllerName
from .plugin_controller import PluginController
from .rate_and_delay import DELAY, RATE
from .user_parameters import list_parameters, make_controller


def parse(text: str, vehicle: str = "", values: Optional[Mapping[str, float]] = None) -> Any:
    """Make a controller from a text in the format of the option ``--controller``.

    Parameters
    ----------
    text : str
        ``NAME[:KEY=VALUE,...]``, where KEY is a parameter, ``rate`` or ``delay``; a gains file
        (.yaml); or your own controller as ``FILE.py[:NAME]`` or ``MODULE:NAME``, optionally with
        ``:KEY=VALUE,...``. ``FILE.so`` is the library of a C++ plugin.
    vehicle : str, optional
        Name of the robot in its URDF. The built-in gains for this robot replace the defaults.
    values : mapping of str to float, optional
        Rate, delay and parameters, which override those of the text.

    Raises
    ------
    InputError
        If the controller, a parameter, the file, the module or the name does not exist, or the
        object cannot be called as a controller.

    Warns
    -----
    QuadcoreWarning
        If the gains in the file belong to another vehicle.
    """
    added = _find_added_reader(text)
    if added is not None:
        return _set_all(added.make(text), values or {})
    if names_gains_file(text):
        read = gains.read(text)
        if vehicle and read.vehicle not in ("", vehicle):
            warn(
                f"{text}: these gains are for '{read.vehicle}', but '{vehicle}' uses them. "
                "Tune gains for it with quadcore tune."
            )
        if read.law in NAMES:
            return _set_all(read.make(), values or {})
        name, given = split_own(text)
        make: Callable[..., Any] = PluginController if names_plugin(name) else _make_own
        return make(name, {**given, **(values or {})})
    name, _, rest = text.partition(":")
    if name in NAMES:
        given = read_values(f"controller '{text}'", rest)
        return _set_all(make_for_vehicle(name, vehicle), {**given, **(values or {})})
    if names_plugin(text):
        given = read_values(f"controller '{text}'", split_name(text).values)
        return PluginController(split_name(text).place, {**given, **(values or {})})
    if ":" in text or names_file(text):
        return _make_own(text, values or {})
    raise _core.InputError(
        f"controller '{text}' does not exist.{suggest(text, NAMES)} Choose one of "
        f"{', '.join(NAMES)}, a gains file that ends in .yaml, FILE.py[:NAME], or MODULE:NAME."
    )


def names_plugin(text: str) -> bool:
    """Whether a text names a plugin library."""
    return split_name(text).place.endswith(".so")


def uses_plugin(text: str) -> bool:
    """Whether a text names a plugin library, or a gains file for a plugin."""
    return names_plugin(gains.read(text).law if names_gains_file(text) else text)


class FileReader(NamedTuple):
    """Reader for YAML files of another kind that describe a controller."""

    reads: Callable[[str], bool]
    """Returns whether the reader can read a file."""
    make: Callable[[str], Any]
    """Makes the controller that a file describes."""


_ADDED: List[FileReader] = []


def add_reader(reader: FileReader) -> None:
    """Register a reader of files for `parse`."""
    _ADDED.append(reader)


def _find_added_reader(text: str) -> Optional[FileReader]:
    if not _names_yaml(text):
        return None
    return next((reader for reader in _ADDED if reader.reads(text)), None)


def names_added_file(text: str) -> bool:
    """Whether a text names a file that a registered reader can read."""
    return _find_added_reader(text) is not None


def names_gains_file(text: str) -> bool:
    """Whether a text names a gains file."""
    return _names_yaml(text) and not names_added_file(text)


def _names_yaml(text: str) -> bool:
    return text.lower().endswith((".yaml", ".yml"))


def split_own(text: str) -> Tuple[str, Dict[str, float]]:
    """Split the text of a user-defined controller into its name and the given values."""
    if names_gains_file(text):
        read = gains.read(text)
        timing = {"rate": read.rate, "delay": read.delay}
        if names_plugin(read.law):
            if timing != {"rate": RATE, "delay": DELAY}:
                raise _core.InputError(
                    f"{text}: '{read.law}' is a plugin, which sets its own rate and delay. Remove "
                    "both."
                )
            timing = {}
        return read.law, {**timing, **read.parameters}
    split = split_name(text)
    name = f"{split.place}:{split.name}" if split.name else split.place
    return name, read_values(f"controller '{text}'", split.values)


def read_own(text: str) -> Gains:
    """Import a user-defined controller, and return its timing and parameters.

    Parameters
    ----------
    text
        As for `parse`.

    Raises
    ------
    InputError
        As for `parse`; also if the text names an autopilot.
    """
    if names_added_file(text):
        raise _core.InputError(f"{text}: this controller has no gains to tune. Name another.")
    name, given = split_own(text)
    defaults: Dict[str, float] = {}
    find_controller(name, lambda found: defaults.update(list_parameters(found)) or found)
    made = _make_own(name, given)
    timing = {"rate": RATE, "delay": DELAY}
    for each, default in timing.items():
        timing[each] = float(getattr(made, each, default))
    parameters = {each: value for each, value in given.items() if each not in timing}
    return Gains(name, "", **timing, parameters={**defaults, **parameters})


def _set_all(controller: Any, values: Mapping[str, float]) -> Any:
    for name, value in values.items():
        set_parameter(controller, name, value)
    return controller


def _make_own(text: str, values: Mapping[str, float]) -> Any:
    """Import a user-defined controller, and make it with parameter values."""
    who = f"controller '{text}'"
    given = {**read_values(who, split_name(text).values), **values}
    timing: Dict[str, float] = {}
    for name in {"rate", "delay"} & set(given):
        timing[name] = given.pop(name)
    made = find_controller(text, lambda found: make_controller(who, found, given))
    return _set_all(made, timing)


_COMMON = """\
rate : float
    Calls per simulated second, 1/s.
delay : float
    Time from a call until its command reaches the motors, s.
spins : sequence of float
    Direction of each rotor, 1 or -1. Default: neighbouring rotors turn in opposite directions.
belief : Simulation, optional
    Vehicle that the controller is designed for. Default: the simulated vehicle."""


def _make_function(
    name: str, summary: str, table: List[_core.ParameterSpec]
) -> Callable[..., BuiltInController]:
    def make(
        *,
        rate: float = RATE,
        delay: float = DELAY,
        spins: Sequence[float] = (),
        belief: Optional[_core.Simulation] = None,
        **parameters: float,
    ) -> BuiltInController:
        return BuiltInController(name, rate, delay, spins, belief, **parameters)

    make.__name__ = make.__qualname__ = name
    make.__doc__ = write_docstring(summary, table, _COMMON)
    make.__signature__ = make_signature(make, table)  # type: ignore[attr-defined]
    return make


_MAKERS = {entry[0]: _make_function(*entry) for entry in _core.controllers()}
NAMES: Tuple[ControllerName, ...] = tuple(_MAKERS)
FIRMWARE: Tuple[ControllerName, ...] = ("crazyflie_pid", "mellinger", "px4")
"""Controllers with the gains of a firmware, which suit only the vehicles of this firmware."""
__all__ = [
    "FIRMWARE",
    "NAMES",
    "BuiltInController",
    "crazyflie_pid",
    "geometric",
    "indi",
    "lqr",
    "mellinger",
    "parse",
    "pd",
    "pd_compensated",
    "pid",
    "pid_thesis",
    "px4",
    "read_controller",
]  # fmt: skip

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .keywords import Cascade, CrazyfliePid, Geometric, Indi, Lqr, Mellinger, Px4

    def pd(**parameters: Unpack[Cascade]) -> BuiltInController: ...
    def pd_compensated(**parameters: Unpack[Cascade]) -> BuiltInController: ...
    def pid_thesis(**parameters: Unpack[Cascade]) -> BuiltInController: ...
    def pid(**parameters: Unpack[Cascade]) -> BuiltInController: ...
    def geometric(**parameters: Unpack[Geometric]) -> BuiltInController: ...
    def indi(**parameters: Unpack[Indi]) -> BuiltInController: ...
    def lqr(**parameters: Unpack[Lqr]) -> BuiltInController: ...
    def crazyflie_pid(**parameters: Unpack[CrazyfliePid]) -> BuiltInController: ...
    def mellinger(**parameters: Unpack[Mellinger]) -> BuiltInController: ...
    def px4(**parameters: Unpack[Px4]) -> BuiltInController: ...
else:

    def __getattr__(name: str) -> Callable[..., BuiltInController]:
        try:
            return _MAKERS[name]
        except KeyError:
            known = ", ".join(NAMES)
            raise AttributeError(
                f"controller '{name}' does not exist. Use one of {known}."
            ) from None
