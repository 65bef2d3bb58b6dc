"""Which tags say how hard rotors push, how the air resists and how motors lag."""

from __future__ import annotations

from itertools import chain
from typing import Mapping, Tuple

DRAGS: Mapping[str, Tuple[str, ...]] = {
    "profile": ("profileDragCoeff",),
    "parasitic": ("parasiticDragCoeff",),
    "translational": ("translationalDragCoeff",),
    "induced": ("inducedDragCoeff",),
    "flapping": ("flappingA1c", "flappingA1s", "flappingB1", "flappingB2"),
}
"""Drags of libaerodynamic_plugin, in the order of chapter 6, by the tags that switch them off."""

SAID: Mapping[str, Mapping[str, int]] = {
    "thrust": {"rotorThrustCoeff": 1, "rotorTorqueCoeff": 1, "motorConstant": 1},
    "drag": dict.fromkeys(
        [*chain(*DRAGS.values()), "rotorDragCoefficient", "rollingMomentCoefficient"], 1
    ),
    "lag": {"kp": -1, "timeConstantUp": 1, "timeConstantDown": 1},
}
"""What may be otherwise than believed: thrust and torque of the rotors, resistance of the air, time
constant of the motors. Of each the tags of libaerodynamic_plugin, libmotorpid_plugin,
libmotor_plugin and RotorS' motor model that say it, and the power of the factor that they take.
"""
