"""The engine gazebo11 against flights of real Gazebo 11.

tests/data/gazebo11 holds thinned recordings (scripts/thin_recordings.py). Where the environment
variable QUADCORE_RECORDINGS names a folder of the same layout, the recordings there are flown too.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import quadcore as qc

# One recording has an integral gain without limits, on purpose.
pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")

DATA = Path(__file__).resolve().parents[1] / "data" / "gazebo11"
FOLDERS = [DATA]
if "QUADCORE_RECORDINGS" in os.environ:
    FOLDERS.append(Path(os.environ["QUADCORE_RECORDINGS"]))

DRAGS = ("induced", "translational", "profile", "parasitic")


def name_of(path):
    name = path.name.replace(".csv.gz", "")
    return name if DATA in path.parents else f"full-{name}"


FLIGHTS = [path for folder in FOLDERS for path in sorted(folder.glob("S*.csv.gz"))]
CASES = [path for folder in FOLDERS for path in sorted(folder.glob("cases/[AB]*"))]
CONVERTED = {"shipped": ("quadrotor", DATA / "quadrotor_as_converted_by_gazebo.sdf")}
CONVERTED.update((name_of(case), (case / "model.urdf", case / "model.sdf")) for case in CASES)


def measure_distances(simulation, commands, record):
    """Largest distance (m) and angle (degrees) between a flight and the rows of its recording."""
    recorded = np.loadtxt(record, delimiter=",", skiprows=1)
    log = simulation.run(recorded[-1, 0], commands=commands)
    rows = np.rint(recorded[:, 0] / simulation.dt).astype(int)
    assert np.allclose(log.time[rows], recorded[:, 0], rtol=0, atol=1e-9)
    apart = np.linalg.norm(log.position[rows] - recorded[:, 1:4], axis=1)
    # The vector part of the quaternion between the two is the sine of half the angle.
    a, b = log.orientation[rows], recorded[:, 4:8]
    between = a[:, 3:] * b[:, :3] - b[:, 3:] * a[:, :3] - np.cross(a[:, :3], b[:, :3])
    angle = 2 * np.degrees(np.arcsin(np.linalg.norm(between, axis=1)))
    return apart.max(), angle.max()


def test_every_folder_holds_flights():
    for folder in FOLDERS:
        assert any(folder in path.parents for path in FLIGHTS), folder


@pytest.mark.parametrize("record", FLIGHTS, ids=name_of)
def test_the_shipped_quadrotor_flies_as_recorded(record):
    number, slow, drag = re.match(r"S(\d+)_slow([\d.]+)_(\w+)\.csv", record.name).groups()
    parameters = {"drone_plugin.sim_slow": slow, "motorpid_plugin.sim_slow": slow}
    for name in DRAGS:
        if drag not in (name, "all"):
            parameters[f"drone_plugin.{name}DragCoeff"] = 0
    simulation = qc.Simulation("quadrotor", parameters=parameters, spawn=(0, 0, 10))
    apart, angle = measure_distances(simulation, record.parent / f"commands_S{number}.csv", record)
    assert apart < 1e-9
    assert angle < 1e-8


COMPILED_IN = {"induced": 0.01, "translational": 0.0025, "profile": 0.005, "parasitic": 0.003}


def test_the_urdf_of_the_thesis_flies_as_recorded_once_its_drag_is_written_out():
    model = DATA.parent / "thesis" / "quadrotor.urdf.xacro"
    drag = {f"drone_plugin.{name}DragCoeff": value for name, value in COMPILED_IN.items()}
    simulation = qc.Simulation(model, parameters=drag, spawn=(0, 0, 10))
    assert simulation.warnings == []
    apart, angle = measure_distances(
        simulation, DATA / "commands_S5.csv", DATA / "S5_slow10_all.csv.gz"
    )
    assert apart < 1e-9
    assert angle < 1e-8


def test_the_urdf_of_the_thesis_as_printed_is_another_vehicle_and_warns():
    model = DATA.parent / "thesis" / "quadrotor.urdf.xacro"
    with pytest.warns(qc.QuadcoreWarning, match="no drag is set.*A.5"):
        simulation = qc.Simulation(model, spawn=(0, 0, 10))
    simulation.command([500, -500, 500, -500])
    as_printed = simulation.run(10, log_every=1000).position[-1, 2] - 10
    meant = qc.Simulation("quadrotor", spawn=(0, 0, 10))
    meant.command([500, -500, 500, -500])
    climb = meant.run(10, log_every=1000).position[-1, 2] - 10
    assert as_printed == pytest.approx(53.03, abs=0.005)
    assert climb == pytest.approx(44.74, abs=0.005)


@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_other_models_and_worlds_fly_as_recorded(case):
    lines = (case / "params.txt").read_text().splitlines()
    spawn = next(line.split()[1:] for line in lines if line.startswith("spawn "))
    simulation = qc.Simulation(case / "model.urdf", world=case / "case.world", spawn=spawn)
    apart, angle = measure_distances(simulation, case / "commands.csv", case / "record.csv.gz")
    assert apart < 1e-8
    assert angle < 1e-7


@pytest.mark.parametrize(("model", "converted"), CONVERTED.values(), ids=CONVERTED.keys())
def test_a_model_has_the_very_numbers_of_gazebos_conversion(model, converted):
    sdf = ElementTree.parse(converted).getroot()
    model = qc.Simulation(model).model

    def numbers(element, *paths):
        return [float(word) for path in paths for word in element.findtext(path, "0").split()]

    links = sdf.findall("model/link")
    assert [link.name for link in model.links] == [link.get("name") for link in links]
    for link, expected in zip(model.links, links):
        assert [link.mass, *link.center_of_mass, 0, 0, 0] == numbers(
            expected, "inertial/mass", "inertial/pose"
        )
        assert [*link.inertia[0], *link.inertia[1, 1:], link.inertia[2, 2]] == numbers(
            expected, *(f"inertial/inertia/i{ij}" for ij in ("xx", "xy", "xz", "yy", "yz", "zz"))
        )

    joints = sdf.findall("model/joint")
    assert [joint.name for joint in model.joints] == [joint.get("name") for joint in joints]
    for joint, expected in zip(model.joints, joints):
        assert [*joint.xyz, *joint.rpy, *joint.axis, joint.damping] == numbers(
            expected, "pose", "axis/xyz", "axis/dynamics/damping"
        )
