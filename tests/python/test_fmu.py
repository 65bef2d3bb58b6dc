"""FMUs: a vehicle that others fly."""

import os
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import numpy as np
import pytest
from flights import ENGINES, HOVER, with_pilot
from imported import Imported, library
from pages import ROOT, run
from processes import run_command, run_refused

import quadcore as qc

fmpy = pytest.importorskip("fmpy")
from fmpy.validation import validate_fmu  # noqa: E402

NOISY = {"odometry.positionNoise": 0.02, "motorpid_plugin.ki": 2e-4, "motorpid_plugin.iMax": 2e-3}
SHORT = {"odometry.rate": 500, **NOISY}


@pytest.fixture(scope="module")
def fmus(tmp_path_factory):
    """Maker of FMUs of the quadrotor, each kind once."""
    folder = tmp_path_factory.mktemp("fmus")
    made = {}

    def make(engine="eigen", model="quadrotor", **options):
        key = (engine, model, repr(options))
        if key not in made:
            made[key] = folder / f"{len(made)}.fmu"
            qc.export_fmu(made[key], model, engine=engine, **options)
        return made[key]

    return make


@pytest.fixture
def import_fmu(fmus, tmp_path):
    """Maker of instances, which end with the test."""
    open_ones = []

    def make(*arguments, path=None, parameters=None, initialise=True, **options):
        where = tmp_path / str(len(open_ones))
        path = path or fmus(*arguments, **options)
        instance = Imported(path, where, initialise=initialise, **(parameters or {}))
        open_ones.append(instance)
        return instance

    yield make
    for instance in open_ones:
        instance.close()


def logged_row(simulation):
    s = simulation.state
    return [*s.position, *s.orientation, *s.linear_velocity, *s.angular_velocity, *s.rotor_velocity]


@pytest.mark.parametrize("engine", ENGINES)
def test_an_importer_finds_nothing_wrong_and_every_variable_explained(fmus, engine):
    path = fmus(engine)
    assert validate_fmu(str(path)) == []
    description = fmpy.read_model_description(str(path))
    variables = {v.name: v for v in description.modelVariables}
    inputs = [name for name, v in variables.items() if v.causality == "input"]
    assert {"w1", "w2", "w3", "w4", "effectiveness.s1"} <= set(inputs)
    assert variables["w1"].unit == "rad/s" and variables["wrench_thrust.fz"].unit == "N"
    tag = variables["drone_plugin.rotorThrustCoeff"]
    assert (tag.variability, tag.type) == ("tunable", "Real")
    assert variables["drone_plugin.dragModel"].variability == "fixed"
    assert variables["drone_plugin.dragModel"].start == "appendix"
    assert variables["odom.x"].causality == variables["x"].causality == "output"


def read_odometry(vehicle):
    """Return the odometry of a simulation or of an FMU as a controller reads it."""
    message = vehicle.topic("odom")
    parts = {
        "position": ("x", "y", "z"),
        "orientation": ("qx", "qy", "qz", "qw"),
        "linear_velocity": ("vx", "vy", "vz"),
        "angular_velocity": ("wx", "wy", "wz"),
    }
    return SimpleNamespace(
        **{part: np.array([message[field] for field in fields]) for part, fields in parts.items()}
    )


@pytest.mark.parametrize("engine", ["gazebo11", "eigen"])
def test_a_controller_that_closes_the_loop_flies_the_spiral_as_on_the_simulation(
    engine, import_fmu
):
    """Return the bits of states, odometry and wrenches at whole steps of the controller's rate."""
    fast = {"xacro_args": {"max_velocity": "1e6"}}
    instance = import_fmu(engine, **fast)
    simulation = qc.Simulation("quadrotor", engine=engine, **fast)
    reference = qc.references.spiral()
    controllers = [qc.controllers.geometric() for _ in range(2)]
    for controller in controllers:
        controller.reset(simulation)
    parts = ["fx", "fy", "fz", "tx", "ty", "tz"]
    terms = [f"wrench_{term}.{part}" for term in simulation.wrench_terms for part in parts]
    for k in range(500):
        t = k * 0.002
        for controller, fly in zip(controllers, (instance, simulation)):
            fly.command(controller(t, read_odometry(fly), reference(t)))
        instance.step(0.002)
        simulation.step(2)
    assert instance.row() == logged_row(simulation)
    wrenches = simulation.run(0, wrenches=True).wrenches
    assert instance.get(*terms) == [
        x for name in simulation.wrench_terms for x in wrenches[name][0]
    ]
    assert np.linalg.norm(simulation.state.position - reference(1.0).position) < 0.5


@pytest.mark.parametrize("engine", ENGINES)
def test_a_state_saved_restored_and_serialised_flies_on_bit_for_bit(engine, import_fmu):
    instance = import_fmu(engine, parameters=SHORT)

    def on():
        instance.command(HOVER * 1.02)
        rows = []
        for _ in range(20):
            instance.step()
            rows.append([*instance.row(), *instance.get("odom.x", "odom.stamp")])
        return rows

    on()
    time, state = instance.time, instance.slave.getFMUstate()
    data = instance.slave.serializeFMUstate(state)
    expected = on()
    for saved in (state, instance.slave.deSerializeFMUstate(data)):
        instance.slave.setFMUstate(saved)
        instance.time = time
        assert on() == expected
        instance.slave.freeFMUstate(saved)
    other = import_fmu(
        engine
    )  # another instance, whose parameters are those of the state afterwards
    other.slave.setFMUstate(other.slave.deSerializeFMUstate(data))
    assert other.slave.serializeFMUstate(other.slave.getFMUstate()) == data
    instance, instance.time = other, time
    assert on() == expected


def test_a_damaged_or_foreign_state_is_refused(import_fmu):
    instance, other = import_fmu("eigen"), import_fmu("eigen", spawn=(0, 0, 3))
    data = instance.slave.serializeFMUstate(instance.slave.getFMUstate())
    for damaged in (data[:-3], data + b"1", data[:102] + b"\xff" * 8 + data[110:]):
        with pytest.raises(Exception, match="fmi2DeSerializeFMUstate"):
            instance.slave.deSerializeFMUstate(damaged)
        assert "the saved state is damaged. Save it again." in instance.said[-1][1]
    with pytest.raises(Exception, match="fmi2DeSerializeFMUstate"):
        other.slave.deSerializeFMUstate(data)
    assert "belongs to another FMU" in other.said[-1][1]


def test_parameters_are_those_of_the_simulation(import_fmu):
    parameters = {**SHORT, "drone_plugin.dragModel": "chapter2", "odometry.publishTf": False}
    instance = import_fmu(
        "ode", parameters={**parameters, "seed": 7, "spawn.z": 3.5, "spawn.yaw": 1.0}
    )
    simulation = qc.Simulation(
        "quadrotor", "ode", parameters=parameters, seed=7, spawn=(0, 0, 3.5, 0, 0, 1)
    )
    for fly in (instance, simulation):
        fly.command(HOVER * 1.1)
    instance.step(0.1)
    simulation.step(100)
    assert instance.row() == logged_row(simulation)
    assert instance.get("odom.x") == [simulation.topic("odom")["x"]]
    assert instance.slave.getString([instance.reference("drone_plugin.dragModel")]) == [b"chapter2"]


def test_a_tunable_parameter_changes_in_flight(import_fmu):
    instance, simulation = import_fmu("eigen"), qc.Simulation("quadrotor", "eigen")
    for fly in (instance, simulation):
        fly.command(HOVER)
    instance.step(0.01)
    simulation.step(10)
    instance.set("drone_plugin.rotorThrustCoeff", 5e-6)
    tuned = qc.Simulation("quadrotor", "eigen", parameters={"drone_plugin.rotorThrustCoeff": 5e-6})
    tuned.restore(simulation.snapshot(), allow=["parameters"])
    instance.step(0.01)
    tuned.step(10)
    simulation.step(10)
    assert instance.row() == logged_row(tuned) != logged_row(simulation)


def test_errors_are_reported_through_the_logger(import_fmu, fmus):
    instance = import_fmu("eigen", initialise=False, parameters={"motorpid_plugin.kp": -1.0})
    with pytest.raises(Exception, match="fmi2EnterInitializationMode"):
        instance.initialise()
    status, text = instance.said[-1]
    assert status == 3
    assert re.search(r"plugin 'motorpid_plugin': <kp> '-1' is out of range", text)
    assert "\n" not in text
    instance.slave.reset()
    instance.initialise()
    for time, length, says in (
        (
            0.0,
            0.0015,
            "the communication step is 0.0015 s. Use a whole multiple of the time step of 0.0",
        ),
        (0.0, 0.0, "the communication step is 0 s"),
        (
            0.5,
            0.001,
            "the step starts at 0.500000 s, but the flight is at 0.000000 s. Continue from there.",
        ),
    ):
        with pytest.raises(Exception, match="fmi2DoStep"):
            instance.slave.doStep(time, length)
        assert says in instance.said[-1][1]
    with pytest.raises(Exception, match="fmi2SetReal"):
        instance.command([float("nan")] * 4)
    instance.command(HOVER)
    instance.step()


def test_a_flight_that_fails_says_when_and_why(import_fmu):
    instance = import_fmu("eigen", parameters={"motorpid_plugin.kp": 1e9})
    instance.command([1e300] * 4)
    with pytest.raises(Exception, match="fmi2DoStep"):
        instance.step(1.0)
    assert "t = " in instance.said[-1][1]


def test_different_fmus_fly_in_one_process_without_a_word_to_each_other(import_fmu):
    ground = {"world": "default", "spawn": (0, 0, 0.3)}
    kinds = [("ode", {}), ("gazebo11", {}), ("ode", ground), ("eigen", {"model": "hexarotor"})]
    flying = [import_fmu(engine, **options) for engine, options in kinds]
    twins = [qc.Simulation(engine=engine, **options) for engine, options in kinds]
    for k in range(20):
        for instance, twin in zip(flying, twins):
            speeds = [300 + k] * twin.rotor_count
            for fly in (instance, twin):
                fly.command(speeds)
            instance.step(0.01)
            twin.step(10)
    for instance, twin in zip(flying, twins):
        assert instance.get("x", "y", "z", "wx", "wy", "wz") == [
            *twin.state.position, *twin.state.angular_velocity
        ]  # fmt: skip


@pytest.mark.parametrize("engine", ["ode", "gazebo11"])
def test_instances_fly_side_by_side_in_threads(engine, import_fmu):
    """Each in a thread that did not make it."""

    def fly(instance):
        instance.command(HOVER)
        for _ in range(200):
            instance.step()
        return instance.row()

    with ThreadPoolExecutor(4) as pool:
        rows = list(pool.map(fly, [import_fmu(engine) for _ in range(4)]))
    simulation = qc.Simulation("quadrotor", engine)
    simulation.command(HOVER)
    simulation.step(200)
    assert rows == [logged_row(simulation)] * 4


def test_files_that_tags_name_travel_inside(import_fmu, tmp_path):
    folder = tmp_path / "piloted"
    instance = import_fmu("eigen", model=with_pilot(folder))
    (folder / "gains.yaml").unlink()
    instance.initialise()
    instance.step(0.1)
    assert "vel_cmd.w1" in instance.variables and "w1" not in instance.variables


def test_plugins_of_the_machine_do_not_come_in(import_fmu, fmus, tmp_path, monkeypatch):
    path = fmus("eigen")
    (tmp_path / "libaerodynamic_plugin.so").write_text("no library")
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", str(tmp_path))
    instance = import_fmu(path=path)
    instance.step()


def test_the_same_vehicle_is_the_same_file(fmus, tmp_path):
    qc.export_fmu(tmp_path / "again.fmu", "quadrotor", engine="eigen")
    assert (tmp_path / "again.fmu").read_bytes() == fmus("eigen").read_bytes()


HERE = os.path.dirname(__file__)
BARE = """
import ctypes, os, sys
sys.path.insert(0, sys.argv[1])
import fmpy
from pathlib import Path
from imported import Imported
one = Imported(Path(sys.argv[2]), Path(sys.argv[3]))
one.command([480.0, -470.0, 480.0, -470.0])
for _ in range(10):
    one.step()
assert "quadcore" not in sys.modules
loaded = {line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}
print(*(name for name in loaded if "ode" in name.split("/")[-1] or "libquadcore" in name))
print(one.row())
"""


def test_it_flies_where_neither_quadcore_nor_ode_is(fmus, tmp_path):
    """What the FMU needs lies in it, beside the C and C++ libraries that every machine has."""
    instance_folder = tmp_path / "bare"
    done = subprocess.run(
        [sys.executable, "-c", BARE, HERE, str(fmus("ode")), str(instance_folder)],
        env={}, capture_output=True, text=True, cwd="/", check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    others, row = done.stdout.splitlines()
    assert others == ""
    needed = subprocess.run(
        ["/usr/bin/ldd", str(library(instance_folder))], env={}, capture_output=True, text=True
    ).stdout
    for name, where in re.findall(r"(\S+) => (\S+)", needed):
        base = re.match(r"lib(c|m|stdc\+\+|gcc_s|dl|pthread)\.so", name)
        assert base or where.startswith(str(instance_folder)), needed
    simulation = qc.Simulation("quadrotor", "ode")
    simulation.command([480.0, -470.0, 480.0, -470.0])
    simulation.step(10)
    assert eval(row) == logged_row(simulation)


DRIVER = """
#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
static void say(void* e, const char* i, int s, const char* c, const char* text, ...) { puts(text); }
typedef struct { void *logger, *allocate, *free, *finished, *environment; } Callbacks;
int main(int n, char** v) {
  void* library = dlopen(v[1], RTLD_NOW | RTLD_LOCAL);
  if (!library) { puts(dlerror()); return 1; }
#define GET(name, result, ...) result (*name)(__VA_ARGS__) = dlsym(library, #name)
  GET(fmi2Instantiate, void*, const char*, int, const char*, const char*, Callbacks*, int, int);
  GET(fmi2EnterInitializationMode, int, void*);
  GET(fmi2ExitInitializationMode, int, void*);
  GET(fmi2DoStep, int, void*, double, double, int);
  GET(fmi2GetReal, int, void*, const unsigned*, unsigned long, double*);
  Callbacks callbacks = {say};
  void* one = fmi2Instantiate("one", 1, v[2], "file:///resources", &callbacks, 0, 0);
  if (!one || fmi2EnterInitializationMode(one) || fmi2ExitInitializationMode(one)) return 3;
  if (fmi2DoStep(one, 0, 0.1, 0)) return 2;
  const unsigned reference = 2;
  double z;
  fmi2GetReal(one, &reference, 1, &z);
  printf("%.17g\\n", z);
  return 0;
}
"""


def test_it_flies_in_a_system_with_nothing_but_the_libraries_of_c_and_cpp(fmus, tmp_path):
    """Another root, where there is no Python, and a program of forty lines."""
    root = tmp_path / "root"
    fmpy.extract(str(fmus("ode")), str(root))
    (tmp_path / "fly.c").write_text(DRIVER)
    compiled = subprocess.run(
        ["cc", "-w", "-o", str(root / "fly"), str(tmp_path / "fly.c"), "-ldl"], capture_output=True
    )
    assert compiled.returncode == 0, compiled.stderr
    base = re.compile(r"(/\S*/(?:ld-linux\S*|lib(?:c|m|stdc\+\+|gcc_s|dl|pthread)\.so\S*))")
    for binary in (root / "fly", library(root)):
        listed = subprocess.run(["ldd", str(binary)], capture_output=True, text=True).stdout
        for file in base.findall(listed):
            target = root / file.lstrip("/")
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(file, str(target))
    assert next(v for v in variables_of(root) if v.valueReference == 2).name == "z"
    guid = fmpy.read_model_description(str(root)).guid
    inside = f"/{library(root).relative_to(root)}"
    flown = subprocess.run(
        ["unshare", "-r", "chroot", str(root), "/fly", inside, guid], capture_output=True, text=True
    )
    if "Operation not permitted" in flown.stderr:
        pytest.skip("needs a system that lets users make a root of their own")
    assert flown.returncode == 0, flown.stdout + flown.stderr
    simulation = qc.Simulation("quadrotor", "ode")
    simulation.step(100)
    assert float(flown.stdout) == simulation.state.position[2]


def variables_of(folder):
    return fmpy.read_model_description(str(folder)).modelVariables


def test_the_command_line_writes_one(tmp_path):
    path = tmp_path / "x.fmu"
    done = run_command("export-fmu", "quadrotor", "--engine", "eigen", "--set", "odometry.rate=100",
               "-o", str(path))  # fmt: skip
    assert done.returncode == 0 and done.stdout == f"written {path}\n"
    variables = fmpy.read_model_description(str(path)).modelVariables
    assert [v.start for v in variables if v.name == "odometry.rate"] == ["100"]
    assert "Name a file that ends in .fmu" in run_refused("export-fmu", "quadrotor", "-o", "x.zip")
    assert "nor a built-in model" in run_refused(
        "export-fmu", "nothing", "-o", str(tmp_path / "y.fmu")
    )
    assert not (tmp_path / "y.fmu").exists()


FIRST = """
import os, sys
sys.path.insert(0, sys.argv[1])
from imported import Imported
one = Imported(sys.argv[2], __import__("pathlib").Path(sys.argv[3]))
one.step()
import quadcore as qc
assert not qc.plugin_folders()[-1].startswith(sys.argv[3])
simulation = qc.Simulation("quadrotor")
simulation.step(1)
assert one.get("z") == [simulation.state.position[2]]
"""


def test_python_flies_by_its_own_core_after_an_fmu_was_flown(fmus, tmp_path):
    """The loader takes a library for one that it has loaded under the same name."""
    done = subprocess.run(
        [sys.executable, "-c", FIRST, HERE, str(fmus("gazebo11")), str(tmp_path / "one")],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("model", ["quadrotor", "firefly"])
def test_it_flies_again_when_the_folder_of_its_first_flight_is_gone(model, fmus, tmp_path):
    rows = []
    for name in ("first", "second"):
        instance = Imported(fmus(model=model), tmp_path / name)
        instance.step(0.1)
        rows.append(instance.row())
        instance.close()
        shutil.rmtree(str(tmp_path / name))
    assert rows[0] == rows[1]


def test_the_climb_of_the_page_arrives(tmp_path):
    said = run(ROOT / "docs" / "fmu.md", tmp_path)
    assert float(re.search(r"\d+\.\d+", said)[0]) == pytest.approx(3.0, abs=0.1)
