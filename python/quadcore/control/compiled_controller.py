"""Controllers that are compiled functions."""

from __future__ import annotations

import ctypes
from typing import Any, ClassVar, Optional, Sequence

import numpy as np

from .._core import InputError
from ..support.arguments import shorten
from .rate_and_delay import DELAY, RATE
from .reference_ahead import list_fields
from .vectorized import VectorState

_NUMBERS = ctypes.POINTER(ctypes.c_double)
_FUNCTION = ctypes.CFUNCTYPE(None).__mro__[1]
_TAKES_INTERPRETER = 4  # flag of a function that holds the interpreter lock


class CompiledController:
    """Controller that is a compiled function, which the core calls without the interpreter.

    The function is ``void f(double t, double *state, double *reference, double *data, double
    *speeds)``. It must not keep the pointers after the call:

    - `t`: simulation time, s.
    - `state`: 13 measured values in the order of `Odometry`: position (m), orientation (x, y, z,
      w), linear velocity (m/s), angular velocity (rad/s).
    - `reference`: 18 values in the order of `Reference`: position, velocity, acceleration, jerk and
      snap in world axes (m, s); yaw, yaw rate and yaw acceleration (rad, s).
    - `data`: values of the controller, which the function may change.
    - `speeds`: signed rotor speeds, rad/s, one for each rotor; the function writes them.

    If a subclass overrides `__call__`, or another object wraps the controller, Python makes the
    calls instead of the core.

    Parameters
    ----------
    function : numba CFunc or ctypes function
        Function made by ``numba.cfunc(CompiledController.signature)`` or by `prototype`.
    rate : float, default 500
        Calls per simulated second, 1/s.
    delay : float, default 0
        Actuation delay: time from a call until its command reaches the motors, s.

    Attributes
    ----------
    signature : str
        Signature of the function for numba.
    prototype : type
        Type of the function for ctypes.

    Raises
    ------
    InputError
        If the function is not compiled, or has other arguments.
    """

    signature: ClassVar[str] = f"void(float64{4 * ', CPointer(float64)'})"
    prototype: ClassVar[Any] = ctypes.CFUNCTYPE(None, ctypes.c_double, *4 * [_NUMBERS])

    def __init__(self, function: Any, rate: float = RATE, delay: float = DELAY) -> None:
        self.rate, self.delay = rate, delay
        self._made_of = function  # numba frees the code of a function that has no references
        self._function = _find_function(function)
        self._data = np.empty(0)
        self._width: Optional[int] = None  # unknown until the first run

    def make_data(self, simulation: Any) -> Any:
        """Return the values of `data` at the start of a run, such as gains and filter states.

        Parameters
        ----------
        simulation : Simulation or Vehicle
            Vehicle of the run, as passed to `Controller.reset`.
        """
        return ()

    def reset(self, simulation: Any) -> None:
        """Prepare for a run.

        Parameters
        ----------
        simulation : Simulation or Vehicle
            Vehicle of the run.

        Raises
        ------
        InputError
            If the data are not a one-dimensional array of numbers.
        """
        given = self.make_data(simulation)
        try:
            self._data = np.array(given, dtype=float)
            is_list = self._data.ndim == 1
        except (TypeError, ValueError):
            is_list = False
        if not is_list:
            raise InputError(
                f"controller: its make_data returned {shorten(given)}. Return a list of numbers."
            )
        self._width = simulation.command_width

    @property
    def compiled(self) -> Optional[CompiledController]:
        """The controller itself; None if a subclass overrides `__call__`."""
        return self if type(self).__call__ is CompiledController.__call__ else None

    @property
    def address(self) -> int:
        """Address of the function."""
        return _find_address(self._function)

    @property
    def data(self) -> np.ndarray:
        """Values of the controller, shape (n,)."""
        return self._data

    def __call__(self, t: float, state: Any, reference: Any) -> np.ndarray:
        """Return the signed rotor speeds, rad/s; see `Controller`."""
        if self._width is None:
            raise InputError("controller: no run has begun. Call reset(simulation) first.")
        if reference is None:
            raise InputError("controller: a compiled function needs a reference. Give one.")
        measured = np.concatenate([getattr(state, name) for name in VectorState._fields])
        speeds = np.full(self._width, np.nan)
        rows = (measured, np.array(list_fields(reference)), self._data, speeds)
        self._function(t, *(row.ctypes.data_as(_NUMBERS) for row in rows))
        return speeds


def find_compiled(controller: Any) -> Optional[CompiledController]:
    """Return the compiled controller that the core can call instead of `controller`, or None.

    Only the class of the controller may define the property `compiled`. If an object forwards the
    attributes of another controller, they are ignored, because the object may change the command.
    """
    if not isinstance(getattr(type(controller), "compiled", None), property):
        return None
    found = controller.compiled
    return found if isinstance(found, CompiledController) else None


def is_compiled(given: Any) -> bool:
    """Whether an object is a compiled function."""
    return isinstance(getattr(given, "ctypes", given), _FUNCTION)


def _find_address(function: Any) -> int:
    """Return the address of a ctypes function; 0 if it has none."""
    return ctypes.cast(function, ctypes.c_void_p).value or 0


def _find_function(given: Any) -> Any:
    """Return the ctypes function of a compiled function; raise `InputError` if it is invalid."""
    if not is_compiled(given):
        raise InputError(
            f"controller: {shorten(given)} is not a compiled function. Compile it with "
            "numba.cfunc(quadcore.CompiledController.signature)."
        )
    function = getattr(given, "ctypes", given)
    wanted = CompiledController.prototype
    if not _find_address(function) or function._flags_ & _TAKES_INTERPRETER:
        raise InputError(
            "controller: the function is not compiled, or has no address. Make it with "
            "numba.cfunc(quadcore.CompiledController.signature) or CompiledController.prototype."
        )
    arguments: Sequence[Any] = function.argtypes or ()
    if (function.restype, tuple(arguments)) != (wanted._restype_, wanted._argtypes_):
        raise InputError(
            "controller: the compiled function has other arguments than "
            f"{CompiledController.signature}. Declare these."
        )
    return function
