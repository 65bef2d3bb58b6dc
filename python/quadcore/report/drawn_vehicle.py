"""Geometry of vehicles and worlds as the player draws them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Optional, Sequence, Tuple

import numpy as np

_ARM = 0.25  # m, length of the arms of an unknown vehicle
_GREY = (0.6, 0.6, 0.6, 1.0)


@dataclass(frozen=True, eq=False)
class DrawnShape:
    """A solid of one colour.

    Attributes
    ----------
    kind : str
        ``box``, ``cylinder`` (along z), ``sphere`` or ``mesh``.
    size : tuple of float
        Box: edges along x, y, z; cylinder: radius, length; sphere: radius; mesh: scale along x, y,
        z. In m, except the scale.
    pose : ndarray (4, 4)
        Homogeneous matrix from the shape to its body, m.
    colour : tuple of float
        Red, green, blue and opacity, from 0 to 1.
    vertices : ndarray (n, 3), optional
        Corners of a mesh in its own axes, before the scale.
    faces : ndarray (m, 3), optional
        Triangles of a mesh as indices of corners.
    """

    kind: str
    size: Tuple[float, ...]
    pose: np.ndarray
    colour: Tuple[float, ...] = _GREY
    vertices: Optional[np.ndarray] = None
    faces: Optional[np.ndarray] = None


@dataclass(frozen=True, eq=False)
class DrawnBody:
    """The frame of a vehicle, or one of its rotors.

    Attributes
    ----------
    pose : ndarray (4, 4)
        Homogeneous matrix from the body to the frame with all joints at angle zero, m.
    axis : ndarray (3,)
        Unit vector about which the body turns, in its own axes; zero for the frame.
    shapes : sequence of DrawnShape
        Solids; may be empty.
    """

    pose: np.ndarray
    axis: np.ndarray
    shapes: Sequence[DrawnShape]


@dataclass(frozen=True, eq=False)
class DrawnVehicle:
    """A vehicle: the frame, then its rotors in the order of their joints.

    Attributes
    ----------
    name : str
        Name of the model.
    bodies : sequence of DrawnBody
        At least the frame.
    """

    name: str
    bodies: Sequence[DrawnBody]

    @property
    def rotor_count(self) -> int:
        """Number of rotors."""
        return len(self.bodies) - 1

    def fix_rotors(self) -> DrawnVehicle:
        """Return the vehicle with rotors that do not turn, for a log without their speeds."""
        shapes = [
            replace(shape, pose=body.pose @ shape.pose)
            for body in self.bodies
            for shape in body.shapes
        ]
        return DrawnVehicle(self.name, [DrawnBody(np.eye(4), np.zeros(3), shapes)])


@dataclass(frozen=True, eq=False)
class DrawnWorld:
    """Surroundings of the vehicles.

    Attributes
    ----------
    ground : bool
        Whether there is a ground plane at z = 0.
    obstacles : sequence of DrawnShape
        Solids; their poses are in the world.
    """

    ground: bool = False
    obstacles: Sequence[DrawnShape] = ()


def make_generic_vehicle(rotors: int) -> DrawnVehicle:
    """Make a star of arms with a rotor at the end of each, for a log without a model."""
    angles = 2 * np.pi * (np.arange(rotors) + 0.5) / max(1, rotors)
    hub = DrawnShape("cylinder", (0.3 * _ARM, 0.1 * _ARM), np.eye(4))
    arms = [DrawnShape("box", (_ARM, 0.06 * _ARM, 0.05 * _ARM), _turn(angle)) for angle in angles]
    radius = 0.8 * _ARM * np.sin(np.pi / max(3, rotors))
    disc = DrawnShape("cylinder", (radius, 0.02 * _ARM), np.eye(4))
    bodies = [DrawnBody(np.eye(4), np.zeros(3), [hub, *arms])]
    for angle in angles:
        pose = np.eye(4)
        pose[:3, 3] = _ARM * np.array([np.cos(angle), np.sin(angle), 0.1])
        bodies.append(DrawnBody(pose, np.array([0.0, 0.0, 1.0]), [disc]))
    return DrawnVehicle("", bodies)


def _turn(angle: float) -> np.ndarray:
    """Return the pose of an arm that starts at the origin and points to an angle (rad)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    pose = np.eye(4)
    pose[:2, :2] = [[cosine, -sine], [sine, cosine]]
    pose[:2, 3] = _ARM / 2 * np.array([cosine, sine])
    return pose
