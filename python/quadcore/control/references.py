"""References: where a vehicle is to be, with all derivatives.

Each function makes one, e.g. ``quadcore.references.spiral(radius=3)``; its docstring lists the
parameters. ``NAMES`` holds them all.
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
from ..support.arguments import brief
from ..support.parameters import (
    did_you_mean,
    docstring,
    keyword_signature,
    read_values,
    values,
)
from .keywords import ReferenceName

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
    """A function of time that returns a `Reference`, or an object with the same members."""

    def __call__(self, t: float, /) -> ReferencePoint:
        """Return the reference at a time.

        Parameters
        ----------
        t : float
            Simulation time, s.
        """


class Shape:
    """A reference of a kind that quadcore has.

    Parameters
    ----------
    name : str
        Of its kind.
    rows : array_like (points, columns), optional
        Of kinds that go through points, such as ``waypoints``.
    **parameters
        Of the kind, m, s, rad.

    Attributes
    ----------
    name : str
        Of its kind.
    parameters : dict of str to float
        That were given.
    shape : _core.ReferenceShape
        Which says it.
    """

    def __init__(
        self, name: str, rows: Optional[npt.ArrayLike] = None, /, **parameters: Any
    ) -> None:
        self.name = name
        self.parameters = values(f"reference '{name}'", parameters)
        try:
            self.rows = None if rows is None else np.array(rows, dtype=float)
        except (TypeError, ValueError) as error:
            raise _core.InputError(f"reference '{name}': its rows: {error}") from None
        self.shape = _core.ReferenceShape(name, self.parameters, self.rows)

    def __call__(self, t: float) -> _core.Reference:
        """Say where the vehicle is to be at a time [s]."""
        return self.shape.at(t)

    def on(self, simulation: _core.Simulation) -> Shape:
        """Make the same for a vehicle: from the `ground` where that rests, if none is given.

        Parameters
        ----------
        simulation : Simulation
            Of the vehicle.
        """
        parameters = _core.on_vehicle(self.name, self.parameters, simulation)
        if parameters == self.parameters:
            return self
        return Shape(self.name, self.rows, **parameters)

    @property
    def end(self) -> float:
        """From when on nothing moves any more, s; infinite if that never comes."""
        return self.shape.end

    def told(self) -> Dict[str, Any]:
        """Say what it is, in plain values."""
        rows = None if self.rows is None else self.rows.tolist()
        return {"name": self.name, "parameters": self.parameters, "rows": rows}

    def __reduce__(self) -> Any:
        return _again, (self.name, self.rows, self.parameters)

    def __repr__(self) -> str:
        inside = ", ".join(f"{name}={value:g}" for name, value in self.parameters.items())
        return f"quadcore.references.{self.name}({inside})"


def _again(name: str, rows: Optional[np.ndarray], parameters: Any) -> Shape:
    return Shape(name, rows, **parameters)


def start(simulation: Any, reference: ReferenceLike, spins: Sequence[float] = ()) -> State:
    """Give the state of a vehicle that follows a reference exactly from the simulation's time on.

    Parameters
    ----------
    simulation : Simulation
        Says what flies.
    reference : callable
        Of quadcore.references, or a function like one.
    spins : sequence of float
        1 or -1 for each rotor; without, neighbours turn against each other.

    Returns
    -------
    State
        Attitude, rates and rotor speeds included; for `Simulation.set_state`.
    """
    if isinstance(reference, Shape):
        reference = reference.on(simulation)
    state: State = simulation.state.copy()
    for name, value in _core.start_on(simulation, reference(state.time), list(spins)).items():
        setattr(state, name, value)
    return state


def hover_at(pose: Sequence[float]) -> Shape:
    """Make the reference that stays at x, y, z [m] and the yaw of roll, pitch, yaw [rad]."""
    x, y, z, _, _, yaw = pose
    return Shape("hover", x=x, y=y, height=z, yaw=yaw)


def places(reference: ReferenceLike, times: np.ndarray) -> np.ndarray:
    """Give x, y, z [m] and yaw [rad] of a reference at each of some times [s]; shape (n, 4)."""
    if isinstance(reference, Shape):
        return np.asarray(reference.shape.places(times))
    return np.array([_place(reference(t)) for t in times.tolist()], dtype=float).reshape(-1, 4)


def _place(wanted: Any) -> List[float]:
    try:
        x, y, z = wanted.position
        return [float(x), float(y), float(z), float(wanted.yaw)]
    except (AttributeError, TypeError, ValueError):
        raise _core.InputError(
            f"the reference gave {brief(wanted)}; give a quadcore.Reference, or what has the "
            "members of one"
        ) from None


_SHIPPED = resources.root() / "config" / "waypoints.yaml"
_FILES = (".csv", ".mat", ".yaml", ".yml", ".bag")


def parse(text: str) -> Shape:
    """Make the reference that a command line names.

    Parameters
    ----------
    text
        ``NAME[:KEY=VALUE,...]``, or the path of a .csv, .mat, .bag or .yaml file of waypoints,
        which ``waypoints:FILE[,KEY=VALUE,...]`` names too; ``waypoints`` alone are those of
        config/waypoints.yaml. The rows of ``series:FILE`` neither begin nor end at rest.

    Raises
    ------
    InputError
        No such reference, parameter or file.
    """
    if text.lower().endswith(_FILES) and text.partition(":")[0] not in NAMES:
        return Shape("waypoints", read_rows(Path(text)))
    name, _, rest = text.partition(":")
    if name not in NAMES:
        raise _core.InputError(
            f"there is no reference '{name}'{did_you_mean(name, NAMES)}; write one of "
            f"{', '.join(NAMES)}, or the name of a "
            f"file that ends in {', '.join(_FILES)}"
        )
    if name in _OF_ROWS:
        parts = rest.split(",")
        given = [part for part in parts if "=" in part and not part.lower().endswith(_FILES)]
        file = ",".join(part for part in parts if part not in given)
        if not file and name != _SHIPPED.stem:
            raise _core.InputError(f"reference '{name}' has no rows; write {name}:FILE")
        parameters = read_values(f"reference '{text}'", ",".join(given))
        return Shape(name, read_rows(Path(file) if file else _SHIPPED), **parameters)
    return Shape(name, **read_values(f"reference '{text}'", rest))


def read_rows(path: Path) -> npt.ArrayLike:
    """Read rows of time and place.

    Parameters
    ----------
    path
        A .csv file with columns t, x, y, z and perhaps yaw, or a log, a .yaml file with `columns`,
        these, and `rows`, a .mat file with t, x, y, z, or a bag of a flight.

    Raises
    ------
    InputError
        A missing file, or one that holds something else.
    """
    if path.suffix.lower() in (".csv", ".yaml", ".yml"):
        return _core.read_rows(str(path))
    if path.suffix.lower() == ".mat":
        return mat.read_path(path)
    if path.suffix.lower() == ".bag":
        return bag.read_path(path)
    raise _core.InputError(f"{path}: paths are read from {', '.join(_FILES)} files")


def _function(
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
    make.__doc__ = docstring(summary, table, rows if takes_rows else "")
    make.__signature__ = keyword_signature(make, table)  # type: ignore[attr-defined]
    return make


_MAKERS = {entry[0]: _function(*entry) for entry in _core.references()}
NAMES: Tuple[ReferenceName, ...] = tuple(_MAKERS)
_OF_ROWS = tuple(entry[0] for entry in _core.references() if entry[3])
__all__ = [
    "NAMES",
    "Reference",
    "ReferenceLike",
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
            raise AttributeError(f"there is no reference '{name}'; there are {known}") from None
