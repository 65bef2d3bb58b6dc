"""What controllers believe to fly."""

from __future__ import annotations

from typing import Optional

from .. import _core


def believed(
    who: str, belief: Optional[_core.Simulation], simulation: _core.Simulation
) -> _core.Simulation:
    """Give the simulation that a controller believes to fly: its belief, or what flies.

    Raises
    ------
    InputError
        Odometry that it cannot read, or a belief with another number of rotors.
    """
    twist = {
        p.value
        for plugin in simulation.plugins
        for p in plugin.parameters
        if p.name == "twistFrame"
    }
    if twist == {"body"}:
        raise _core.InputError(f"{who} needs velocities in the world; set <twistFrame> to world")
    if belief is None:
        return simulation
    if belief.rotor_count != simulation.rotor_count:
        raise _core.InputError(
            f"{who} believes in {belief.rotor_count} rotors; "
            f"this vehicle has {simulation.rotor_count}"
        )
    return belief
