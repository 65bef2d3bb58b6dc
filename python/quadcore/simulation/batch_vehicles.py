"""Models and parameters of the vehicles of a batch."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from .._core import InputError, Model, World
from ..model.description import read_both
from ..model.overrides import XACRO, apply_link_values, check_names, split_xacro_arguments
from ..support.values import check_whole, format_value


class Vehicles(NamedTuple):
    """Model and tag values of each vehicle in order, and their common world."""

    models: List[Model]
    tags: List[Dict[str, str]]
    world: World


MOST = 1_000_000
"""Maximum number of vehicles in a batch; each vehicle needs some kilobytes."""


def check_vehicle_count(n: object) -> int:
    """Return the number of vehicles; raise `InputError` if it is invalid."""
    count = check_whole(n, "n")
    if not 1 <= count <= MOST:
        raise InputError(f"n is {count}. Give a number of vehicles from 1 to {MOST}.")
    return count


def read_vehicles(
    n: int,
    model: Union[str, Path, Model],
    world: Union[str, Path, World, None],
    parameters: Optional[Mapping[str, Any]],
    xacro_args: Optional[Mapping[str, Any]],
    ignore: Sequence[str],
) -> Vehicles:
    """Read the models of n vehicles; each distinct model is read only once.

    Raises
    ------
    InputError
        If the model, the world or a parameter is invalid, or an array does not have n values.
    """
    arguments, others = split_xacro_arguments(parameters, xacro_args)
    of_xacro = _split_values(n, {f"{XACRO}.{name}": value for name, value in arguments.items()})
    read: Dict[Tuple[Tuple[str, str], ...], Model] = {}
    built: List[Tuple[Model, Dict[str, str]]] = []
    before: Any = None
    for given, values in zip(of_xacro, _split_values(n, others)):
        now = tuple(
            (name[len(XACRO) + 1 :], _format_argument(value)) for name, value in given.items()
        )
        if now not in read:
            read[now], world = read_both(model, world, dict(now), ignore)
            check_names(read[now], parameters or {})
            _check_rotors(read[now], built, arguments)
        texts = {key: format_value(value) for key, value in values.items()}
        if (now, texts) != before:
            before = now, texts
            built.append(apply_link_values(read[now], texts))
        else:
            built.append(built[-1])
    assert isinstance(world, World)
    return Vehicles([each for each, _ in built], [tags for _, tags in built], world)


def _format_argument(value: Any) -> str:
    return format_value(value) if isinstance(value, np.ndarray) and value.ndim else str(value)


def explain_refusal(error: InputError, given: Sequence[Any], n: int) -> InputError:
    """Add a hint to an error if the user passed a list where an array gives one value per vehicle.

    Parameters
    ----------
    error
        Error with a message that contains the value.
    given
        Mappings of parameter names to values.
    n
        Number of vehicles.
    """
    for values in given:
        for value in values.values() if isinstance(values, Mapping) else ():
            is_table = isinstance(value, np.ndarray) and value.ndim > 1
            if not is_table and not isinstance(value, (list, tuple)):
                continue
            rows = value if is_table else [value]
            if any(
                text in str(error)
                for row in rows
                for text in (format_value(row), _format_argument(row))
            ):
                return InputError(
                    f"{error} For a value per vehicle, give an array of shape ({n},)."
                )
    return error


def _check_rotors(
    model: Model, built: Sequence[Tuple[Model, object]], arguments: Mapping[str, Any]
) -> None:
    if built and len(model.joints) != len(built[0][0].joints):
        own = [f"{XACRO}.{name}" for name, value in arguments.items() if np.ndim(value)]
        raise InputError(
            f"set {', '.join(own)}: vehicle {len(built)} has {len(model.joints)} rotors, but "
            f"vehicle 0 has {len(built[0][0].joints)}. Make a separate batch for each number of "
            "rotors."
        )


def _split_values(n: int, parameters: Mapping[str, Any]) -> List[Dict[str, Any]]:
    """Return the parameter values of each vehicle by name."""
    for key, value in parameters.items():
        shape: Tuple[int, ...] = value.shape if isinstance(value, np.ndarray) else ()
        if len(shape) == 1 and len(value) != n:
            raise InputError(
                f"set {key}: {len(value)} values for {n} vehicles. Give one for each, or one "
                "number."
            )
        if len(shape) > 1 and (len(shape) > 2 or len(value) != n or shape[1] == 1):
            raise InputError(
                f"set {key}: an array of shape {shape} for {n} vehicles. Give shape ({n},), or "
                f"({n}, k) where a value is a row of k numbers."
            )
    return [
        {
            key: value[i] if isinstance(value, np.ndarray) and value.ndim else value
            for key, value in parameters.items()
        }
        for i in range(n)
    ]
