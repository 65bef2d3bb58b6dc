"""View of a vehicle for controllers: parameters, rotors and sensors, but not the simulation."""

from __future__ import annotations

from typing import Any, Dict, Sequence, Tuple
from weakref import WeakKeyDictionary

import numpy as np

from .. import _core

_SCENARIO_KINDS = ("fault", "wrench", "switch", "carried", "vector", "wind_speed", "shares")
"""Kinds of topics that belong to the scenario: faults, pushes, payloads and wind."""

_SCENARIO_MODULES = ("wind", "push", "fault", "payload")
"""Parts of the file names of scenario plugins."""

_SENSED_SHARES = "health"
"""Topic of kind ``shares`` that controllers may read: the detected loss of each rotor."""


class Vehicle:
    """Model of a vehicle and access to its sensors, as passed to controllers in studies.

    Parameters
    ----------
    simulation : Simulation
        Simulation of the vehicle.
    sensed : Simulation, optional
        Simulation that contains the topics. Default: `simulation`.

    Attributes
    ----------
    model, world : Model, World
        Documents of the vehicle and its world.
    plugins : list of PluginInfo
        Plugins of the vehicle, except for those of the scenario.
    dt : float
        Step of the simulation, s.
    mass : float
        Mass of the vehicle, kg.
    inertia : ndarray (3, 3)
        Inertia about the centre of mass, frame axes, kg m^2.
    center_of_mass : ndarray (3,)
        Centre of mass relative to the frame's origin, frame axes, m.
    gravity : ndarray (3,)
        Gravitational acceleration, world axes, m/s^2.
    rotors : tuple of Rotor
        Description of each rotor.
    rotor_count : int
        Number of rotors.
    hover_speed : ndarray (n,)
        Signed commands at which the vehicle hovers level, rad/s.
    rotor_positions, rotor_axes : ndarray (n, 3)
        Positions relative to the frame's origin, m, and unit vectors of the axes, both in frame
        axes. These and the following arrays are in the order of the command.
    spins : ndarray (n,)
        Direction of rotation about the axis, which is also the sign of the command; 1 or -1.
    thrust_coefficients, torque_coefficients : ndarray (n,)
        Thrust (N s^2/rad^2) and torque (N m s^2/rad^2) per squared speed.
    time_constants : ndarray (n,)
        Time constants of the rotor speeds, s; 0 for rotors without lag.
    min_speeds, max_speeds : ndarray (n,)
        Limits of the commanded speeds, rad/s.
    allocation : ndarray (4, n)
        Thrust along z (N) and torque about the centre of mass (N m) per squared speed (rad^2/s^2).
    """

    def __init__(self, simulation: Any, sensed: Any = None) -> None:
        _SIMULATIONS[self] = simulation
        _SENSED[self] = simulation if sensed is None else sensed
        self.model, self.world, self.dt = simulation.model, simulation.world, simulation.dt
        self.rotors: Tuple[_core.Rotor, ...] = simulation.rotors
        self.rotor_count, self.rotor_names = simulation.rotor_count, simulation.rotor_names
        self.plugins = [
            plugin
            for plugin in simulation.plugins
            if not any(name in plugin.filename for name in _SCENARIO_MODULES)
        ]
        self.command_width: int = simulation.command_width
        self.mass: float = simulation.mass
        self.gravity = np.array(simulation.gravity)
        self.inertia = np.array(simulation.inertia)
        for name, value in _describe(simulation).items():
            setattr(self, name, value)

    @property
    def vehicle(self) -> Vehicle:
        """The view itself, so that a controller can use ``x.vehicle`` in every flight."""
        return self

    @property
    def topics(self) -> Dict[str, Any]:
        """Topics that a controller may read or publish, by name."""
        known = _SENSED[self].topics
        return {name: topic for name, topic in known.items() if is_sensed(name, topic.kind)}

    def topic(self, name: str) -> Dict[str, float]:
        """Return the latest message of a topic, as `Simulation.topic` does.

        Parameters
        ----------
        name : str
            Name of the topic.

        Raises
        ------
        InputError
            If the topic does not exist or belongs to the scenario.
        """
        check_topic(self, name)
        message: Dict[str, float] = _SENSED[self].topic(name)
        return message

    def publish(self, topic: str, values: Any) -> None:
        """Publish a message to the plugins that read a topic, as `Simulation.publish` does.

        Parameters
        ----------
        topic : str
            Name of the topic.
        values : mapping of str to number, or sequence of numbers
            One number for each field of the topic.

        Raises
        ------
        InputError
            If the topic belongs to the scenario; otherwise as for `Simulation.publish`.
        """
        check_topic(self, topic)
        _SENSED[self].publish(topic, values)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        raise AttributeError(
            f"a controller in a study receives a Vehicle, which has no '{name}'. Use the odometry "
            "and the sensors, or add --privileged."
        )

    def __repr__(self) -> str:
        return f"<Vehicle '{self.model.name}', {self.mass:g} kg, {self.rotor_count} rotors>"


_SIMULATIONS: WeakKeyDictionary[Vehicle, Any] = WeakKeyDictionary()
_SENSED: WeakKeyDictionary[Vehicle, Any] = WeakKeyDictionary()


def unwrap(vehicle: Any) -> Any:
    """Return the simulation of a view; other objects are returned unchanged."""
    return _SIMULATIONS[vehicle] if isinstance(vehicle, Vehicle) else vehicle


def is_sensed(name: str, kind: str) -> bool:
    """Whether controllers may use a topic, because it does not belong to the scenario."""
    return kind not in _SCENARIO_KINDS or (kind == "shares" and name == _SENSED_SHARES)


def check_topic(vehicle: Vehicle, name: str) -> None:
    """Raise `InputError` if a topic belongs to the scenario."""
    found = _SENSED[vehicle].topics.get(name)
    if found is not None and not is_sensed(name, found.kind):
        raise _core.InputError(
            f"topic '{name}' belongs to the scenario, not to the controller. Write it in the "
            "scenario, or add --privileged."
        )


def _describe(simulation: Any) -> Dict[str, Any]:
    """Return the arrays of a vehicle; empty if no plugin drives its rotors by speed."""
    try:
        found = _core.modelled_vehicle(simulation, {}, [])
        hover = _core.hover_commands(simulation, [])
    except _core.InputError:
        return {}
    rotors = sorted(
        (rotor for rotor in simulation.rotors if rotor.command_index is not None),
        key=lambda rotor: rotor.command_index,
    )
    return {
        "center_of_mass": found["center_of_mass"],
        "inertia": found["inertia"],
        "hover_speed": np.asarray(hover),
        "rotor_positions": _stack([rotor.position for rotor in rotors]),
        "rotor_axes": found["axes"],
        "spins": found["spins"],
        "thrust_coefficients": _stack([rotor.thrust_coefficient for rotor in rotors]),
        "torque_coefficients": _stack([rotor.torque_coefficient for rotor in rotors]),
        "time_constants": found["time_constants"],
        "min_speeds": found["min_speeds"],
        "max_speeds": found["max_speeds"],
        "allocation": found["effectiveness"][2:],
    }


def _stack(values: Sequence[Any]) -> np.ndarray:
    return np.array(values, dtype=float)
