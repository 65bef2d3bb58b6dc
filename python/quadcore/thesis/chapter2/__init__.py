"""Mathematical model of chapter 2 of the thesis, independent of the engines and plugins.

Its coordinates are the position and the Euler angles of the vehicle in the world,

    q = [xi, eta],   xi = [x, y, z],   eta = [phi, theta, psi]                          (2.3)

and its equation of motion is the Euler-Lagrange equation

    B(q) qddot + C(q, qdot) qdot + g + G_a(q, omega) qdot + F(q, qdot, omega) qdot
        = zeta = K_zeta(q) Omega,   Omega = [omega_1^2, ..., omega_n^2]         (2.38), (2.40)

`vehicle` contains the parameters of a vehicle, and `kinematics` contains (2.3)-(2.9). `matrices`
contains one function for each matrix above. `model` contains the motors, the terms that the thesis
omits, and the integration. Numbers in parentheses are equations of the thesis. If a function
differs from the printed equation, its docstring gives the reason. All quantities are in SI units,
and angles are in radians.

>>> import quadcore as qc
>>> from quadcore.thesis.chapter2 import MathematicalModel, Vehicle
>>> simulation = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
>>> model = MathematicalModel(Vehicle.of(simulation))
>>> log = model.fly(1.0, [[0, 480, -480, 480, -480]], simulation.state.copy())
"""

from .model import GYROSTAT, THESIS, MathematicalModel, Terms
from .vehicle import Vehicle

__all__ = ["GYROSTAT", "THESIS", "MathematicalModel", "Terms", "Vehicle"]
