"""Names of the built-in controllers and references and of their parameters, for type checkers.

The core's tables define all of them; a test compares the two.
"""

from __future__ import annotations

from typing import Literal, Optional, Sequence, TypedDict

from .. import _core

ControllerName = Literal["pd", "pd_compensated", "pid_thesis", "pid", "geometric", "indi", "lqr"]
ReferenceName = Literal[
    "hover",
    "step",
    "ramp",
    "spiral",
    "circle",
    "eight",
    "waypoints",
    "series",
    "takeoff_land",
]


class Setup(TypedDict, total=False):
    """Keyword arguments of every controller."""

    rate: float
    delay: float
    spins: Sequence[float]
    belief: Optional[_core.Simulation]


class VehicleModel(TypedDict, total=False):
    """Parameters of the vehicle model inside a controller."""

    drag: bool
    gyroscopic: bool
    lead: bool
    lead_time: float
    believed_mass: float
    believed_inertia: float
    believed_thrust: float
    believed_drag: float
    believed_lag: float
    rate_damping: float
    slowest: float
    fastest: float


class InnerLoopGains(VehicleModel, total=False):
    """Parameters of `InnerLoop`."""

    kr_rp: float
    kw_rp: float
    kr_yaw: float
    kw_yaw: float


class PositionGains(TypedDict, total=False):
    """Gains of a position controller."""

    kp_xy: float
    ki_xy: float
    kd_xy: float
    kp_z: float
    ki_z: float
    kd_z: float


class Cascade(Setup, PositionGains, VehicleModel, total=False):
    """Keyword arguments of the cascaded controllers."""

    scale: float
    kp_rp: float
    ki_rp: float
    kd_rp: float
    kp_yaw: float
    ki_yaw: float
    kd_yaw: float
    feed_forward: bool
    flat_rates: bool


class Geometric(Setup, PositionGains, InnerLoopGains, total=False):
    """Keyword arguments of the geometric controller."""

    integral_limit: float
    feed_forward: bool
    flat_rates: bool
    integral: bool


class Indi(Geometric, total=False):
    """Keyword arguments of the INDI controller."""

    filter: float


class Lqr(Setup, VehicleModel, total=False):
    """Keyword arguments of the LQR controller."""

    q_integral: float
    q_position: float
    q_velocity: float
    q_tilt: float
    q_rate: float
    r_tilt: float
    q_height_integral: float
    q_height: float
    q_climb: float
    r_thrust: float
    q_yaw: float
    q_yaw_rate: float
    r_yaw: float
    sum_limit: float
    integral: bool
    feed_forward: bool
    flat_rates: bool


class Hover(TypedDict, total=False):
    """Parameters of the hover reference."""

    x: float
    y: float
    height: float
    yaw: float
    yaw_rate: float


class Step(Hover, total=False):
    """Parameters of the step reference."""

    dx: float
    dy: float
    dz: float
    dyaw: float
    time: float


class Ramp(Hover, total=False):
    """Parameters of the ramp reference."""

    vx: float
    vy: float
    vz: float
    time: float
    along: bool


class Circle(Hover, total=False):
    """Parameters of the circle and the spiral."""

    radius: float
    rate: float
    climb: float
    along: bool


class Eight(Hover, total=False):
    """Parameters of the figure of eight."""

    length: float
    width: float
    rate: float
    along: bool


class Waypoints(TypedDict, total=False):
    """Parameters of the waypoints."""

    yaw: float
    yaw_rate: float
    along: bool


class Series(Waypoints, total=False):
    """Parameters of the series."""

    tolerance: float


class TakeoffLand(TypedDict, total=False):
    """Parameters of take-off and landing."""

    x: float
    y: float
    yaw: float
    turn: float
    height: float
    ground: float
    wait: float
    rise: float
    stay: float
