"""Parameters of a vehicle for the equations of chapter 2."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import Dict, List, Sequence

import numpy as np

from ..._core import InputError, PluginInfo
from ...formats.mat import write_variables
from ...simulation.simulation import Simulation
from .kinematics import skew


@dataclass(frozen=True)
class Vehicle:
    """Parameters of the mathematical model in body axes, for n rotors in the order of a command.

    The equations of the thesis have four rotors along z of the body. Here each rotor has its own
    arm and axis, so the equations apply to any vehicle.
    """

    mass: float
    """Mass m of the whole vehicle, kg."""
    inertia: np.ndarray
    """Inertia I_B (2.1) of the vehicle with its rotors about its centre of mass, kg m^2; (3, 3)."""
    center_of_mass: np.ndarray
    """Centre of mass (2.2) from the origin of the frame link, m; (3,)."""
    arms: np.ndarray
    """Rotor positions from the centre of mass, d e_1 + h e_3 and so on in (2.33), m; (n, 3)."""
    axes: np.ndarray
    """Unit vectors along the rotor joints, e_3 in (2.22); (n, 3)."""
    rotor_inertia: np.ndarray
    """Inertia I_R of each rotor about its axis, kg m^2; (n,)."""
    gravity: np.ndarray
    """Gravity in world axes, m/s^2; (3,). In the thesis it is [0, 0, -g_z]."""
    wind: np.ndarray
    """Velocity of the air in world axes, m/s; (3,). In the thesis it is zero."""
    k: float
    """Thrust per squared speed (2.10), N s^2/rad^2."""
    b: float
    """Reaction torque per squared speed (2.11), N m s^2/rad^2; negative if it opposes the spin."""
    K_I: float
    """Induced drag coefficient (2.28), N s/m."""
    K_T: float
    """Translational drag coefficient, K_T1 in (2.29), N s/m."""
    K_P: float
    """Profile drag coefficient (2.30), N s/m."""
    K_par: float
    """Parasitic drag coefficient (2.31), N s^2/m^2."""
    A_1c: float
    """Blade flapping coefficient (2.26), rad."""
    A_1s: float
    """Blade flapping coefficient (2.26), rad."""
    B_1: float
    """Blade flapping coefficient (2.27), s/rad."""
    B_2: float
    """Blade flapping coefficient (2.27), s/rad."""
    r: float
    """Rotor radius (2.26), m."""
    motor_gain: float
    """Motor torque per speed error, as in the engines (A.4), N m s/rad."""
    joint_damping: np.ndarray
    """Friction of the rotor joints, N m s/rad; (n,)."""
    fastest: float
    """Limit of the commanded speed, rad/s."""
    slow: float
    """sim_slow, the ratio of the speed in the force models to the joint velocity (chapter 4)."""

    @classmethod
    def of(cls, simulation: Simulation) -> Vehicle:
        """Read the parameters from the model, world and plugins of a simulation.

        Raises
        ------
        InputError
            If chapter 2 has no equations for the vehicle.
        """
        air, motor = (
            read_parameters(find_air_plugin(simulation)),
            read_parameters(find_motor_plugin(simulation)),
        )
        integral = float(motor["ki"]) * (float(motor["iMax"]) - float(motor["iMin"]))
        if integral != 0 or float(motor["kd"]) != 0:
            raise InputError("the mathematical model has proportional motors. Set <ki>, <kd> to 0.")
        if motor["commandTimeout"] != "off":
            raise InputError("the mathematical model has no <commandTimeout>. Remove it.")
        for plugin in (air, motor):
            if sorted(plugin["rotorJoints"].split()) != sorted(simulation.rotor_names):
                raise InputError("the mathematical model needs every rotor in each <rotorJoints>")
        order = list_command_order(simulation)
        joints = [simulation.model.joints[i] for i in order]
        links = [simulation.model.links[1 + i] for i in order]  # the first link is the frame
        from scipy.spatial.transform import Rotation  # scipy is slow to import

        turns = [Rotation.from_euler("xyz", joint.rpy) for joint in joints]
        parts = list(zip(joints, links, turns))
        places = [joint.xyz + turn.apply(link.center_of_mass) for joint, link, turn in parts]
        return cls(
            mass=simulation.mass,
            inertia=simulation.inertia,
            center_of_mass=simulation.center_of_mass,
            arms=np.array(places) - simulation.center_of_mass,
            axes=np.array([turn.apply(joint.axis) for joint, _, turn in parts]),
            rotor_inertia=np.array([j.axis @ link.inertia @ j.axis for j, link, _ in parts]),
            gravity=simulation.world.gravity,
            wind=simulation.world.wind,
            k=float(air["rotorThrustCoeff"]),
            b=float(air["rotorTorqueCoeff"]) * (1 if air["reactionTorque"] == "thesis" else -1),
            K_I=float(air["inducedDragCoeff"]),
            K_T=float(air["translationalDragCoeff"]),
            K_P=float(air["profileDragCoeff"]),
            K_par=float(air["parasiticDragCoeff"]),
            A_1c=float(air["flappingA1c"]),
            A_1s=float(air["flappingA1s"]),
            B_1=float(air["flappingB1"]),
            B_2=float(air["flappingB2"]),
            r=float(air["rotorRadius"]),
            motor_gain=float(motor["kp"]),
            joint_damping=np.array([joint.damping for joint in joints]),
            fastest=np.inf if motor["maxVelocity"] == "none" else float(motor["maxVelocity"]),
            slow=float(motor["sim_slow"]),
        )

    def to_mat(self, path: Path) -> None:
        """Write all parameters by name to a MATLAB file, for the scripts in `matlab/`."""
        write_variables(path, {field.name: getattr(self, field.name) for field in fields(self)})

    @cached_property
    def levers(self) -> np.ndarray:
        """[1; S(r_i)], (n, 6, 3): wrench about the centre of mass per force at rotor i (2.33).

        The printed equation contains D x r, but the torque is r x D.
        """
        return np.array([np.vstack([np.eye(3), skew(arm)]) for arm in self.arms])

    @cached_property
    def thrust_wrenches(self) -> np.ndarray:
        """Body wrench of the thrust per squared speed of each rotor; (6, n)."""
        wrenches: np.ndarray = self.k * np.einsum("iaj,ij->ai", self.levers, self.axes)
        return wrenches

    @cached_property
    def discs(self) -> np.ndarray:
        """1 - a a^T, (n, 3, 3): projection onto the disc plane of rotor i."""
        return np.array([np.eye(3) - np.outer(axis, axis) for axis in self.axes])

    @cached_property
    def disc_drag(self) -> np.ndarray:
        """Negative body wrench per body twist of the forces D_i = -V_pi on all rotors; (6, 6).

        V_pi = disc_i (V_B + nu x r_i) is the velocity of a rotor in its disc plane. The printed
        equations (2.28)-(2.30) lack the minus sign.
        """
        drag: np.ndarray = np.einsum("iaj,ijk,ibk->ab", self.levers, self.discs, self.levers)
        return drag

    @property
    def linear_drag(self) -> np.ndarray:
        """Drag (2.28)-(2.30) of all rotors: `disc_drag` times the sum of the coefficients."""
        drag: np.ndarray = (self.K_I + self.K_T + self.K_P) * self.disc_drag
        return drag

    @property
    def flaps(self) -> bool:
        """Whether any blade flapping coefficient is nonzero."""
        return any((self.A_1c, self.A_1s, self.B_1, self.B_2))


def find_air_plugin(simulation: Simulation) -> PluginInfo:
    """Find the plugin with the force models of chapter 2, by its thrust."""
    found = [plugin for plugin in simulation.plugins if "thrust" in plugin.wrenches]
    return _find_only(found, "libaerodynamic_plugin.so")


def find_motor_plugin(simulation: Simulation) -> PluginInfo:
    """Find the motor plugin, which receives the commands."""
    commands = simulation.topics.get(simulation.command_topic)
    readers = commands.readers if commands else []
    found = [plugin for plugin in simulation.plugins if plugin.name in readers]
    return _find_only(found, "libmotorpid_plugin.so")


def _find_only(found: Sequence[PluginInfo], such_as: str) -> PluginInfo:
    if len(found) == 1:
        return found[0]
    others = sorted({plugin.filename for plugin in found} - {such_as})
    got = f"{', '.join(others)}" if others else f"{len(found)}"
    raise InputError(
        f"the mathematical model needs one plugin {such_as}, but got {got}. Use another engine."
    )


def read_parameters(plugin: PluginInfo) -> Dict[str, str]:
    """Read the effective parameters of a plugin by name."""
    return _Tags(plugin)


class _Tags(Dict[str, str]):
    """Tag values of a plugin by name; accessing a missing tag raises `InputError`."""

    def __init__(self, plugin: PluginInfo) -> None:
        super().__init__((entry.name, entry.value) for entry in plugin.parameters)
        self._plugin = plugin.name

    def __missing__(self, tag: str) -> str:
        raise InputError(
            f"plugin '{self._plugin}' has no tag <{tag}>, which the mathematical model needs. Use "
            "the built-in plugins."
        )


def list_command_order(simulation: Simulation) -> List[int]:
    """Return the joint indices in command order: `rotor_velocity[list_command_order(s)]`."""
    driven = read_parameters(find_motor_plugin(simulation))["rotorJoints"].split()
    return [simulation.rotor_names.index(name) for name in driven]
