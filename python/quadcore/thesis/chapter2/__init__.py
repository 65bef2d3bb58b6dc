"""The mathematical model of the thesis' chapter 2, apart from the engines and their plugins.

It knows the vehicle by two vectors of the world, position and Euler angles,

    q = [xi, eta],   xi = [x, y, z],   eta = [phi, theta, psi]                          (2.3)

and moves it by the Euler-Lagrange equation

    B(q) qddot + C(q, qdot) qdot + g + G_a(q, omega) qdot + F(q, qdot, omega) qdot
        = zeta = K_zeta(q) Omega,   Omega = [omega_1^2, ..., omega_n^2]         (2.38), (2.40)

`vehicle` says what the model needs to know of a vehicle, `kinematics` holds (2.3)-(2.9),
`matrices` one function for each matrix above, and `model` the motors, the terms that the thesis
leaves out, and the integration. Numbers in parentheses are equations of the thesis; where print and
function differ, the function says why. SI units and radians throughout.

>>> import quadcore as qc
>>> from quadcore.thesis.chapter2 import MathematicalModel, Vehicle
>>> simulation = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
>>> model = MathematicalModel(Vehicle.of(simulation))
>>> log = model.fly(1.0, [[0, 480, -480, 480, -480]], simulation.state.copy())
"""

from .model import GYROSTAT, THESIS, MathematicalModel, Terms
from .vehicle import Vehicle

__all__ = ["GYROSTAT", "THESIS", "MathematicalModel", "Terms", "Vehicle"]
