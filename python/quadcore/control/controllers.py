"""Built-in controllers.

Each function makes a controller, for example ``quadcore.controllers.geometric(kp_xy=4)``; its
docstring lists the parameters. ``NAMES`` contains all names. `read_controller` reads a gains file.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, List, Optional, Sequence, Tuple

from .. import _core
from ..support.parameters import make_signature, read_values, suggest, write_docstring
from ..support.user_code import import_controller, names_file
from ..support.warning import warn
from . import gains
from .built_in import BuiltInController
from .gains import make_for_vehicle, read_controller
from .keywords import ControllerName
from .rate_and_delay import DELAY, RATE


def parse(text: str, vehicle: str = "") -> Any:
    """Make a controller from a text as the option ``--controller`` takes it.

    Parameters
    ----------
    text : str
        ``NAME[:KEY=VALUE,...]`` with parameters, ``rate`` and ``delay`` as keys; a gains file
        (.yaml); or your own controller as ``FILE.py[:NAME]`` or ``MODULE:NAME``.
    vehicle : str, optional
        Name of the robot in its URDF. The gains that are shipped for it become the defaults.

    Raises
    ------
    InputError
        If the controller, a parameter, the file, the module or the name does not exist, or the
        object cannot be called as a controller.

    Warns
    -----
    QuadcoreWarning
        If the gains of the file belong to another vehicle.
    """
    if text.lower().endswith((".yaml", ".yml")):
        read = gains.read(text)
        if vehicle and read.vehicle not in ("", vehicle):
            warn(
                f"{text}: these gains are for '{read.vehicle}', but '{vehicle}' flies with them; "
                "tune some for it (quadcore tune)"
            )
        return read.make()
    name, _, rest = text.partition(":")
    if name in NAMES:
        law = make_for_vehicle(name, vehicle)
        given = read_values(f"law '{text}'", rest)
        law.rate, law.delay = given.pop("rate", law.rate), given.pop("delay", law.delay)
        law.parameters.update(given)
        return law
    if ":" in text or names_file(text):
        return import_controller(text)
    raise _core.InputError(
        f"there is no controller '{text}'{suggest(text, NAMES)}; write one of "
        f"{', '.join(NAMES)}, a gains file that ends in .yaml, FILE.py[:NAME], or MODULE:NAME"
    )


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
__all__ = [
    "NAMES",
    "BuiltInController",
    "geometric",
    "indi",
    "lqr",
    "parse",
    "pd",
    "pd_compensated",
    "pid",
    "pid_thesis",
    "read_controller",
]  # fmt: skip

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .keywords import Cascade, Geometric, Indi, Lqr

    def pd(**parameters: Unpack[Cascade]) -> BuiltInController: ...
    def pd_compensated(**parameters: Unpack[Cascade]) -> BuiltInController: ...
    def pid_thesis(**parameters: Unpack[Cascade]) -> BuiltInController: ...
    def pid(**parameters: Unpack[Cascade]) -> BuiltInController: ...
    def geometric(**parameters: Unpack[Geometric]) -> BuiltInController: ...
    def indi(**parameters: Unpack[Indi]) -> BuiltInController: ...
    def lqr(**parameters: Unpack[Lqr]) -> BuiltInController: ...
else:

    def __getattr__(name: str) -> Callable[..., BuiltInController]:
        try:
            return _MAKERS[name]
        except KeyError:
            known = ", ".join(NAMES)
            raise AttributeError(f"there is no controller '{name}'; there are {known}") from None
