"""Draw how processor time grows with the number of flights, rotors, logged rows and workers.

Writes docs/images/growth.png, and prints the exponent of each line: 1 for proportional growth.
"""

import sys
import tempfile
from math import cos, pi, sin
from pathlib import Path
from time import process_time

import numpy as np
from matplotlib.figure import Figure
from sweeps import plan, seconds

import quadcore as qc
from quadcore.report.plots import png

sys.path.append(str(Path(__file__).parents[1] / "scripts"))
from images import save

ROUNDS = 3  # of which the fastest counts
VEHICLE = {"xacro_args": {"sim_slow": 1}}
SPIRAL = qc.references.spiral()

ROTOR = """
<link name="propeller{i}"><inertial><mass value="0.01"/>
  <inertia ixx="1.4e-5" iyy="1.4e-5" izz="2.8e-5" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="rotor{i}" type="continuous"><parent link="frame"/><child link="propeller{i}"/>
  <origin xyz="{x} {y} 0.02"/><axis xyz="0 0 1"/></joint>"""
MULTIROTOR = """
<robot name="multirotor"><link name="frame"><inertial><mass value="1"/>
  <inertia ixx="0.007" iyy="0.007" izz="0.014" ixy="0" ixz="0" iyz="0"/></inertial></link>{rotors}
<gazebo><plugin name="drone_plugin" filename="libaerodynamic_plugin.so">
  <rotorThrustCoeff>1.1e-5</rotorThrustCoeff><rotorTorqueCoeff>2.7e-7</rotorTorqueCoeff>
  <sim_slow>1</sim_slow><reactionTorque>opposing</reactionTorque>
  <parasiticDragCoeff>0.003</parasiticDragCoeff></plugin></gazebo>
<gazebo><plugin name="motorpid_plugin" filename="libmotorpid_plugin.so">
  <kp>0.0005</kp><sim_slow>1</sim_slow></plugin></gazebo></robot>"""


def measure(act):
    """Return the processor time of the fastest of several calls, s."""
    times = []
    for _ in range(ROUNDS):
        begin = process_time()
        act()
        times.append(process_time() - begin)
    return min(times)


def fly_vehicles(n, engine):
    """Measure n flights of 0.1 s under a controller in one batch, without its construction."""
    batch = qc.BatchSimulation("quadrotor", n, engine, threads=1, **VEHICLE)

    def fly():
        batch.reset()
        batch.run(0.1, controller="geometric", reference=SPIRAL)

    return measure(fly)


def fly_rotors(n, engine, folder):
    """Measure 20,000 steps of a vehicle with n rotors."""
    angles = [2 * pi * i / n for i in range(n)]
    rotors = [ROTOR.format(i=i, x=0.2 * cos(a), y=0.2 * sin(a)) for i, a in enumerate(angles)]
    model = Path(folder) / f"{n}.urdf"
    model.write_text(MULTIROTOR.format(rotors="".join(rotors)))
    simulation = qc.Simulation(model, engine=engine)
    speed = np.sqrt(simulation.mass * 9.8 / n / 1.1e-5)
    simulation.command(speed * (-1.0) ** np.arange(n))
    return measure(lambda: simulation.step(20_000))


def fly_logged(rows_per_second, engine):
    """Measure a flight of 30 s with a controller and so many rows per second."""
    simulation = qc.Simulation("quadrotor", engine=engine, **VEHICLE)
    every = round(1 / rows_per_second / simulation.dt)

    def fly():
        simulation.reset()
        simulation.run(30.0, controller="geometric", reference=SPIRAL, log_every=every)

    return measure(fly)


def fly_rows(workers):
    """Measure 128 rows of a sweep on several processes: the total of all processes."""
    swept = plan(128, "geometric", "circle")
    return min(seconds(swept, workers)[1:].sum() for _ in range(ROUNDS))


def draw(axes, quantity, values, of_engines, exponents):
    """Draw a line for each engine, and print how it grows."""
    for engine, times in of_engines.items():
        axes.loglog(values, times, "o-", label=engine)
        exponent = np.polyfit(np.log(values)[exponents], np.log(times)[exponents], 1)[0]
        print(f"{quantity:20} {engine:9} exponent {exponent:5.2f}   " + describe(values, times))
    axes.set(xlabel=quantity, ylabel="processor time (s)")
    axes.grid(which="both", alpha=0.3)
    axes.legend()


def describe(values, times):
    return ", ".join(f"{value:g}: {time:.3g} s" for value, time in zip(values, times))


def main():
    engines = ("eigen", "gazebo11")
    figure = Figure(figsize=(10, 7), layout="constrained")
    (of_flights, of_rotors), (of_rows, of_workers) = figure.subplots(2, 2)
    flights = [1, 10, 100, 1000, 10_000, 100_000]
    times = {engine: [fly_vehicles(n, engine) for n in flights] for engine in engines}
    draw(of_flights, "flights of 0.1 s", flights, times, slice(2, None))
    rotors = list(range(3, 13))
    with tempfile.TemporaryDirectory() as folder:
        times = {engine: [fly_rotors(n, engine, folder) for n in rotors] for engine in engines}
    draw(of_rotors, "rotors", rotors, times, slice(None))
    rates = [10, 20, 50, 100, 200, 500, 1000]
    times = {engine: [fly_logged(rate, engine) for rate in rates] for engine in engines}
    draw(of_rows, "rows per second", rates, times, slice(None))
    workers = [1, 2, 4]
    draw(of_workers, "workers", workers, {"eigen": [fly_rows(n) for n in workers]}, slice(None))
    for axes in (of_rotors, of_rows, of_workers):  # from zero, where a constant part is seen
        axes.set(xscale="linear", yscale="linear", xlim=(0, None), ylim=(0, None))
    save("growth", png(figure))


if __name__ == "__main__":
    main()
