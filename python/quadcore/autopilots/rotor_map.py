"""Assignment of an autopilot's channels to the rotors of a vehicle, by position and spin."""

from __future__ import annotations

from typing import Any, List, NamedTuple, Sequence

import numpy as np

from .._core import InputError
from ..support.parameters import suggest

_ON_AXIS = 0.2  # fraction of the arm; a rotor closer to an axis is in no quadrant
_SPINS = {1: "counter-clockwise", -1: "clockwise"}


class Place(NamedTuple):
    """Position of a motor in the layout of an autopilot, seen from above."""

    front: int
    """1 in front of the centre, -1 behind it."""
    left: int
    """1 on the left, -1 on the right."""
    spin: int
    """Direction of rotation: 1 counter-clockwise, -1 clockwise."""

    def __str__(self) -> str:
        return f"{describe_quadrant(self.front, self.left)}, {_SPINS[self.spin]}"


class Channel(NamedTuple):
    """Output of an autopilot, and the rotor that it drives."""

    number: int
    """Number of the output, starting at 1."""
    place: Place
    """Position of this motor in the layout of the autopilot."""
    rotor: Any
    """Rotor that the output drives."""

    def __str__(self) -> str:
        return f"{self.number}: {self.place}: {self.rotor.joint}"


def describe_quadrant(front: float, left: float) -> str:
    """Return the name of the quadrant of a position."""
    return f"{'front' if front > 0 else 'rear'} {'left' if left > 0 else 'right'}"


def find_spin(rotor: Any) -> int:
    """Return the spin of a rotor seen from above: 1 counter-clockwise, -1 clockwise."""
    return int(np.sign(rotor.spin * rotor.axis[2]))


def check_reaction(rotors: Sequence[Any], model: str) -> None:
    """Raise `InputError` if an autopilot cannot control the yaw of a vehicle.

    Parameters
    ----------
    rotors
        Rotors of the vehicle.
    model
        Name of the model for the message.
    """
    for rotor in rotors:
        if rotor.torque_sense > 0:
            raise InputError(
                f"model '{model}': <reactionTorque> is thesis, so the torque on the frame is along "
                f"the spin of rotor '{rotor.joint}'. Autopilots expect the opposite sign. "
                "Use --set drone_plugin.reactionTorque=opposing."
            )
        if rotor.torque_sense == 0:
            raise InputError(
                f"model '{model}': rotor '{rotor.joint}' exerts no torque about its axis, so that "
                "an autopilot cannot control yaw. Give the rotor a torque coefficient."
            )


def map_channels(
    layout: Sequence[Place], rotors: Sequence[Any], names: Sequence[str], where: str = ""
) -> List[Channel]:
    """Find the rotor that each output of an autopilot drives.

    Parameters
    ----------
    layout
        Positions of the motors in the order of the outputs.
    rotors
        Rotors of the vehicle.
    names
        Joints of the rotors in the order of the outputs, which override positions and spins. Empty:
        no override.
    where
        Location ``FILE:LINE: `` of the names, for messages.

    Raises
    ------
    InputError
        If the rotors do not match the layout.
    """
    if len(rotors) != len(layout):
        raise InputError(
            f"The autopilot drives {len(layout)} motors, but the model has {len(rotors)} rotors. "
            "Use another model."
        )
    if names:
        return _map_by_name(layout, rotors, names, where)
    arm = max(float(np.hypot(*rotor.position[:2])) for rotor in rotors)
    found: List[Channel] = []
    for number, place in enumerate(layout, 1):
        matching = [rotor for rotor in rotors if _is_in(rotor, place, arm)]
        if len(matching) != 1:
            quadrant = describe_quadrant(place.front, place.left)
            raise InputError(
                f"{len(matching)} rotors are {quadrant}, where the autopilot has motor {number}. "
                "Use a model with an X of rotors, or list their joints as rotors: in the stack "
                "file."
            )
        found.append(Channel(number, place, matching[0]))
    for channel in found:
        if find_spin(channel.rotor) != channel.place.spin:
            spin = _SPINS.get(find_spin(channel.rotor), "in no known direction")
            raise InputError(
                f"rotor '{channel.rotor.joint}' ({describe_quadrant(*channel.place[:2])}) turns "
                f"{spin}, but the autopilot expects {_SPINS[channel.place.spin]}. Change the "
                "model, or set the autopilot's parameter for it and list the rotors in the stack "
                "file."
            )
    return found


def _map_by_name(
    layout: Sequence[Place], rotors: Sequence[Any], names: Sequence[str], where: str
) -> List[Channel]:
    by_name = {rotor.joint: rotor for rotor in rotors}
    for name in names:
        if name not in by_name:
            raise InputError(
                f"{where}rotors: the model has no rotor '{name}'.{suggest(name, list(by_name))} "
                f"Use {', '.join(by_name)}."
            )
    if len(set(names)) != len(layout) or len(names) != len(layout):
        raise InputError(f"{where}rotors: {len(names)} names. Give each of {', '.join(by_name)}.")
    return [
        Channel(number, place, by_name[name])
        for number, (place, name) in enumerate(zip(layout, names), 1)
    ]


def _is_in(rotor: Any, place: Place, arm: float) -> bool:
    x, y = rotor.position[:2]
    return bool(min(x * place.front, y * place.left) > _ON_AXIS * arm)
