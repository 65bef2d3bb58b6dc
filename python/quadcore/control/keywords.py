"""Names and parameters of the built-in controllers and references, for type checkers.

The tables of the core define all of them; a test compares both.
"""

from __future__ import annotations

from typing import Literal, Optional, Sequence, TypedDict

from .. import _core

ControllerName = Literal[
    "pd",
    "pd_compensated",
    "pid_thesis",
    "pid",
    "geometric",
    "indi",
    "lqr",
    "crazyflie_pid",
    "mellinger",
    "px4",
]
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


class CommonModel(TypedDict, total=False):
    """Parameters of the vehicle model in every controller."""

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


class VehicleModel(CommonModel, total=False):
    """Parameters of the vehicle model of controllers with drag and gyroscopic compensation."""

    drag: bool
    gyroscopic: bool


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


class CrazyfliePid(Setup, CommonModel, total=False):
    """Keyword arguments of the PID cascade of the Crazyflie firmware."""

    pos_xy_kp: float
    pos_xy_max: float
    pos_z_kp: float
    pos_z_ki: float
    pos_z_max: float
    vel_xy_kp: float
    vel_xy_ki: float
    vel_tilt_max: float
    vel_z_kp: float
    vel_z_ki: float
    thrust_base: float
    thrust_min: float
    hover_count: float
    att_rp_kp: float
    att_rp_ki: float
    att_rp_limit: float
    att_yaw_kp: float
    att_yaw_ki: float
    att_yaw_kd: float
    att_yaw_limit: float
    rate_rp_kp: float
    rate_rp_ki: float
    rate_rp_kd: float
    rate_rp_limit: float
    rate_yaw_kp: float
    rate_yaw_ki: float
    rate_yaw_limit: float


class Mellinger(Setup, CommonModel, total=False):
    """Keyword arguments of Mellinger's controller of the Crazyflie firmware."""

    force_xy_kp: float
    force_xy_ki: float
    force_xy_kd: float
    force_xy_limit: float
    force_z_kp: float
    force_z_ki: float
    force_z_kd: float
    force_z_limit: float
    moment_xy_kr: float
    moment_xy_kw: float
    moment_xy_kd: float
    moment_z_kr: float
    moment_z_kw: float
    moment_z_ki: float
    moment_z_limit: float
    mass_thrust: float


class Px4(Setup, CommonModel, total=False):
    """Keyword arguments of the cascade of PX4."""

    mpc_xy_p: float
    mpc_z_p: float
    mpc_xy_vel_p_acc: float
    mpc_xy_vel_i_acc: float
    mpc_xy_vel_d_acc: float
    mpc_z_vel_p_acc: float
    mpc_z_vel_i_acc: float
    mpc_z_vel_d_acc: float
    mpc_xy_vel_max: float
    mpc_z_vel_max_up: float
    mpc_z_vel_max_dn: float
    mpc_tiltmax_air: float
    mpc_thr_hover: float
    mpc_thr_min: float
    mpc_thr_max: float
    mpc_veld_lp: float
    mc_rp_p: float
    mc_yaw_p: float
    mc_yaw_weight: float
    mc_rprate_max: float
    mc_yawrate_max: float
    mc_rprate_p: float
    mc_rprate_i: float
    mc_rprate_d: float
    mc_yawrate_p: float
    mc_yawrate_i: float
    mc_yawrate_d: float
    mc_rate_int_lim: float
    imu_dgyro_cutoff: float


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
    """Parameters of the circle and spiral references."""

    radius: float
    rate: float
    climb: float
    along: bool


class Eight(Hover, total=False):
    """Parameters of the figure-of-eight reference."""

    length: float
    width: float
    rate: float
    along: bool


class Waypoints(TypedDict, total=False):
    """Parameters of the waypoint reference."""

    yaw: float
    yaw_rate: float
    along: bool


class Series(Waypoints, total=False):
    """Parameters of the series reference."""

    tolerance: float


class TakeoffLand(TypedDict, total=False):
    """Parameters of the take-off and landing reference."""

    x: float
    y: float
    yaw: float
    turn: float
    height: float
    ground: float
    wait: float
    rise: float
    stay: float
