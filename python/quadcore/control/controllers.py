"""Control laws, as `Simulation.run` flies them.

Each function makes one, e.g. ``quadcore.controllers.geometric(kp_xy=4)``; its docstring lists the
parameters. ``NAMES`` holds them all. `of_file` makes one of a gains file.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, List, Optional, Sequence, Tuple

from .. import _core
from ..support.parameters import did_you_mean, docstring, keyword_signature, read_values
from ..support.user_code import import_controller, names_file
from ..support.warning import warn
from . import gains
from .built_in import BuiltInController
from .gains import law_for, of_file
from .keywords import ControllerName
from .rate_and_delay import DELAY, RATE


def parse(text: str, vehicle: str = "") -> Any:
    """Make the controller that a command line names.

    Parameters
    ----------
    text
        ``LAW[:KEY=VALUE,...]``, keys being those of the law's parameters, ``rate`` and ``delay``;
        a file of gains (.yaml); or your own ``FILE.py[:NAME]`` or ``MODULE:NAME``.
    vehicle
        Name of the robot that is to fly: the parameters of a law that are not given are those that
        are shipped for it, if there are any.

    Raises
    ------
    InputError
        No such law, parameter, file, module or class, or one that cannot be called as a controller.

    Warns
    -----
    QuadcoreWarning
        Gains of a file that are for another vehicle.
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
        law = law_for(name, vehicle)
        given = read_values(f"law '{text}'", rest)
        law.rate, law.delay = given.pop("rate", law.rate), given.pop("delay", law.delay)
        law.parameters.update(given)
        return law
    if ":" in text or names_file(text):
        return import_controller(text)
    raise _core.InputError(
        f"there is no controller '{text}'{did_you_mean(text, NAMES)}; write one of "
        f"{', '.join(NAMES)}, a gains file that ends in .yaml, FILE.py[:NAME], or MODULE:NAME"
    )


_COMMON = """\
rate, delay : float
    Calls per simulated second; s after which a command reaches the motors.
spins : sequence of float
    1 or -1 for each rotor; without, neighbours around the vehicle turn against each other.
belief : Simulation, optional
    A vehicle to take for the one that is flown."""


def _function(
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
    make.__doc__ = docstring(summary, table, _COMMON)
    make.__signature__ = keyword_signature(make, table)  # type: ignore[attr-defined]
    return make


_MAKERS = {entry[0]: _function(*entry) for entry in _core.controllers()}
NAMES: Tuple[ControllerName, ...] = tuple(_MAKERS)
__all__ = [
    "NAMES",
    "BuiltInController",
    "geometric",
    "indi",
    "lqr",
    "of_file",
    "parse",
    "pd",
    "pd_compensated",
    "pid",
    "pid_thesis",
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
