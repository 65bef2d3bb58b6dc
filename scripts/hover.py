"""Simulate a hover to check an installed quadcore."""

import quadcore as qc

simulation = qc.Simulation("quadrotor", xacro_args={"sim_slow": 1}, spawn=(0, 0, 10))
log = simulation.run(5.0, controller="geometric", reference="hover")
height = float(log.position[-1, 2])
print(f"quadcore {qc.__version__} hovers at {height:.6f} m")
assert abs(height - log.position[0, 2]) < 1e-3
