"""Reference trajectories with all derivatives.

Each function makes a reference, for example ``quadcore.references.spiral(radius=3)``. Its docstring
lists the parameters. ``NAMES`` contains all names.
"""

from __future__ import annotations

from pathlib import Path
from typing import (
    TYPE_CHECKING,
    Any,
    Callable,
    Dict,
    List,
    Optional,
    Protocol,
    Sequence,
    Tuple,
    Union,
)

import numpy as np

from .. import _core
from ..formats import bag, mat
from ..model import resources
from ..support.arguments import shorten
from ..support.parameters import (
    check_values,
    make_signature,
    read_values,
    suggest,
    write_docstring,
)
from .keywords import ReferenceName
from .reference_ahead import ReferenceSamples, sample_shape

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..simulation.state import State

Reference = _core.Reference


class ReferencePoint(Protocol):
    """Members of a `Reference`, for type checkers."""

    @property
    def position(self) -> npt.ArrayLike: ...
    @property
    def velocity(self) -> npt.ArrayLike: ...
    @property
    def acceleration(self) -> npt.ArrayLike: ...
    @property
    def jerk(self) -> npt.ArrayLike: ...
    @property
    def snap(self) -> npt.ArrayLike: ...
    @property
    def yaw(self) -> float: ...
    @property
    def yaw_rate(self) -> float: ...
    @property
    def yaw_acceleration(self) -> float: ...


class ReferenceLike(Protocol):
    """Function of time that returns a `Reference`, or an object with the same members."""

    def __call__(self, t: float, /) -> ReferencePoint:
        """Return the reference at a time.

        Parameters
        ----------
        t : float
            Simulation time, s.
        """


class Shape:
    """Built-in reference trajectory.

    Parameters
    ----------
    name : str
        Name of the reference.
    rows : array_like (points, columns), optional
        Points of a reference such as ``waypoints``: t (s), x, y, z (m), and optionally yaw (rad).
    **parameters
        Parameters of the reference in m, s, rad.

    Attributes
    ----------
    name : str
        Name of the reference.
    parameters : dict of str to float
        Parameters that differ from the defaults.
    shape : _core.ReferenceShape
        Object of the core that computes the trajectory.
    """

    def __init__(
        self, name: str, rows: Optional[npt.ArrayLike] = None, /, **parameters: Any
    ) -> None:
        self.name = name
        self.parameters = check_values(f"reference '{name}'", parameters)
        try:
            self.rows = None if rows is None else np.array(rows, dtype=float)
        except (TypeError, ValueError) as error:
            raise _core.InputError(f"reference '{name}': its rows: {error}") from None
        self.shape = _core.ReferenceShape(name, self.parameters, self.rows)

    def __call__(self, t: float) -> _core.Reference:
        """Return the reference at a time (s)."""
        return self.shape.at(t)

    def at(self, times: Any) -> Any:
        """Return the reference at one or several times.

        Parameters
        ----------
        times : float or array_like
            Times, s.

        Returns
        -------
        Reference or ReferenceSamples
            Reference at one time; for an array of times, arrays of its members.
        """
        return sample_shape(self.shape, times)

    def on(self, simulation: _core.Simulation) -> Shape:
        """Return the reference with the defaults for a vehicle, such as the ground height.

        Parameters
        ----------
        simulation : Simulation
            Simulation of the vehicle.
        """
        parameters = _core.on_vehicle(self.name, self.parameters, simulation)
        if parameters == self.parameters:
            return self
        return Shape(self.name, self.rows, **parameters)

    @property
    def end(self) -> float:
        """Time after which the reference is at rest, s; infinite if it never is."""
        return self.shape.end

    def to_dict(self) -> Dict[str, Any]:
        """Return the name, the parameters and the rows as plain values."""
        rows = None if self.rows is None else self.rows.tolist()
        return {"name": self.name, "parameters": self.parameters, "rows": rows}

    def __reduce__(self) -> Any:
        return _make_shape, (self.name, self.rows, self.parameters)

    def __repr__(self) -> str:
        inside = ", ".join(f"{name}={value:g}" for name, value in self.parameters.items())
        return f"quadcore.references.{self.name}({inside})"


def _make_shape(name: str, rows: Optional[np.ndarray], parameters: Any) -> Shape:
    return Shape(name, rows, **parameters)


def start(simulation: Any, reference: ReferenceLike, spins: Sequence[float] = ()) -> State:
    """Return the state of a vehicle that follows a reference exactly at the current time.

    Parameters
    ----------
    simulation : Simulation
        Simulation of the vehicle.
    reference : callable
        Built-in reference, or a function reference(t).
    spins : sequence of float, default ()
        Direction of each rotor, 1 or -1. Default: neighbouring rotors turn in opposite directions.

    Returns
    -------
    State
        State for `Simulation.set_state`, including attitude, angular velocity and rotor speeds.
    """
    if isinstance(reference, Shape):
        reference = reference.on(simulation)
    state: State = simulation.state.copy()
    for name, value in _core.start_on(simulation, reference(state.time), list(spins)).items():
        setattr(state, name, value)
    return state


def make_hover(pose: Sequence[float]) -> Shape:
    """Make a reference that stays at a pose: x, y, z (m), roll, pitch, yaw (rad)."""
    x, y, z, _, _, yaw = pose
    return Shape("hover", x=x, y=y, height=z, yaw=yaw)


def sample_positions(reference: ReferenceLike, times: np.ndarray) -> np.ndarray:
    """Return x, y, z (m) and yaw (rad) of a reference at some times (s), shape (n, 4)."""
    if isinstance(reference, Shape):
        return np.asarray(reference.shape.places(times))
    return np.array([_read_position(reference(t)) for t in times.tolist()], dtype=float).reshape(
        -1, 4
    )


def _read_position(wanted: Any) -> List[float]:
    try:
        x, y, z = wanted.position
        return [float(x), float(y), float(z), float(wanted.yaw)]
    except (AttributeError, TypeError, ValueError):
        raise _core.InputError(
            f"the reference gave {shorten(wanted)}. Give a quadcore.Reference or an object with "
            "the same members."
        ) from None


_SHIPPED = resources.find_root() / "config" / "waypoints.yaml"
_FILES = (".csv", ".mat", ".yaml", ".yml", ".bag")


def parse(text: str) -> Shape:
    """Make a reference from a text in the format of the option ``--reference``.

    Parameters
    ----------
    text : str
        ``NAME[:KEY=VALUE,...]``; or a .csv, .mat, .bag or .yaml file of waypoints, optionally as
        ``waypoints:FILE[,KEY=VALUE,...]``. ``waypoints`` alone reads config/waypoints.yaml.
        ``series:FILE`` reads a path that need not start or end at rest.

    Raises
    ------
    InputError
        If the reference, a parameter or the file does not exist.
    """
    if text.lower().endswith(_FILES) and text.partition(":")[0] not in NAMES:
        return Shape("waypoints", read_rows(Path(text)))
    name, _, rest = text.partition(":")
    if name not in NAMES:
        raise _core.InputError(
            f"reference '{name}' does not exist.{suggest(name, NAMES)} Choose one of "
            f"{', '.join(NAMES)}, or the name of a "
            f"file that ends in {', '.join(_FILES)}."
        )
    if name in _OF_ROWS:
        parts = rest.split(",")
        given = [part for part in parts if "=" in part and not part.lower().endswith(_FILES)]
        file = ",".join(part for part in parts if part not in given)
        if not file and name != _SHIPPED.stem:
            raise _core.InputError(f"reference '{name}' has no rows. Write {name}:FILE.")
        parameters = read_values(f"reference '{text}'", ",".join(given))
        return Shape(name, read_rows(Path(file) if file else _SHIPPED), **parameters)
    return Shape(name, **read_values(f"reference '{text}'", rest))


def read_rows(path: Path) -> npt.ArrayLike:
    """Read rows t (s), x, y, z (m) and optionally yaw (rad) from a file.

    Parameters
    ----------
    path
        .csv file with these columns, a log, .yaml file with ``columns`` and ``rows``, .mat file
        with these vectors, or bag of a flight.

    Raises
    ------
    InputError
        If the file is missing, or does not contain such rows.
    """
    if path.suffix.lower() in (".csv", ".yaml", ".yml"):
        return _core.read_rows(str(path))
    if path.suffix.lower() == ".mat":
        return mat.read_path(path)
    if path.suffix.lower() == ".bag":
        return bag.read_path(path)
    raise _core.InputError(f"{path}: paths are read from {', '.join(_FILES)} files")


def _make_function(
    name: str, summary: str, table: List[_core.ParameterSpec], takes_rows: bool
) -> Callable[..., Shape]:
    if takes_rows:

        def make_of_rows(rows: Union[npt.ArrayLike, str, Path], **parameters: float) -> Shape:
            read = read_rows(Path(rows)) if isinstance(rows, (str, Path)) else rows
            return Shape(name, read, **parameters)

        make: Callable[..., Shape] = make_of_rows
    else:

        def make_of_parameters(**parameters: float) -> Shape:
            return Shape(name, **parameters)

        make = make_of_parameters
    make.__name__ = make.__qualname__ = name
    rows = (
        "rows : array_like (n, 4 or 5), or path of a .csv, .mat, .bag or .yaml file\n"
        "    t, x, y, z[, yaw] in s, m, rad."
    )
    make.__doc__ = write_docstring(summary, table, rows if takes_rows else "")
    make.__signature__ = make_signature(make, table)  # type: ignore[attr-defined]
    return make


_MAKERS = {entry[0]: _make_function(*entry) for entry in _core.references()}
NAMES: Tuple[ReferenceName, ...] = tuple(_MAKERS)
_OF_ROWS = tuple(entry[0] for entry in _core.references() if entry[3])
__all__ = [
    "NAMES",
    "Reference",
    "ReferenceLike",
    "ReferenceSamples",
    "Shape",
    "circle",
    "eight",
    "hover",
    "parse",
    "ramp",
    "series",
    "spiral",
    "start",
    "step",
    "takeoff_land",
    "waypoints",
]  # fmt: skip

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .keywords import Circle, Eight, Hover, Ramp, Series, Step, TakeoffLand, Waypoints

    Rows = Union[npt.ArrayLike, str, Path]

    def hover(**parameters: Unpack[Hover]) -> Shape: ...
    def step(**parameters: Unpack[Step]) -> Shape: ...
    def ramp(**parameters: Unpack[Ramp]) -> Shape: ...
    def spiral(**parameters: Unpack[Circle]) -> Shape: ...
    def circle(**parameters: Unpack[Circle]) -> Shape: ...
    def eight(**parameters: Unpack[Eight]) -> Shape: ...
    def waypoints(rows: Rows, **parameters: Unpack[Waypoints]) -> Shape: ...
    def series(rows: Rows, **parameters: Unpack[Series]) -> Shape: ...
    def takeoff_land(**parameters: Unpack[TakeoffLand]) -> Shape: ...
else:

    def __getattr__(name: str) -> Callable[..., Shape]:
        try:
            return _MAKERS[name]
        except KeyError:
            known = ", ".join(NAMES)
            raise AttributeError(
                f"reference '{name}' does not exist. Use one of {known}."
            ) from None
