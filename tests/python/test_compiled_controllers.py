"""Controllers in compiled functions."""

import ctypes
import subprocess

import numpy as np
import pytest

import quadcore as qc
from quadcore.studies.evaluate.loop_responses import _Injection

NOISY = {"odometry.positionNoise": 0.002, "odometry.angularVelocityNoise": 0.01}
CIRCLE = qc.references.circle(radius=0.2, rate=1)


def command(t, state, reference, data, speeds):
    """Hold height and level; data are the integral of the height error, hover speed and a gain."""
    data[0] += 0.002 * (reference[2] - state[2])
    lift = data[1] + data[2] * (reference[2] - state[2]) + 15.0 * (reference[5] - state[9])
    lift += 5.0 * data[0]
    roll = 160.0 * state[3] + 12.0 * state[10]
    pitch = 160.0 * state[4] + 12.0 * state[11]
    speeds[0], speeds[1] = lift + pitch, -lift - roll
    speeds[2], speeds[3] = lift - pitch, roll - lift


class Interpreted:
    """The same controller in Python."""

    gain = 20.0

    def reset(self, simulation):
        self.data = [0.0, float(simulation.hover_speed[0]), self.gain]

    def __call__(self, t, state, reference):
        row = [*state.position, *state.orientation, *state.linear_velocity, *state.angular_velocity]
        wanted = [*reference.position, *reference.velocity]
        speeds = [0.0] * 4
        command(t, list(map(float, row)), list(map(float, wanted)), self.data, speeds)
        return speeds


class Compiled(qc.CompiledController):
    gain = 20.0

    def make_data(self, simulation):
        return [0.0, simulation.hover_speed[0], self.gain]


def by_ctypes(function=command):
    return Compiled(qc.CompiledController.prototype(function))


def by_numba(function=command):
    numba = pytest.importorskip("numba", reason="needs numba, which pip has")
    return Compiled(numba.cfunc(qc.CompiledController.signature)(function))


def fly(controller, reference=CIRCLE, engine="eigen"):
    sim = qc.Simulation(
        "quadrotor", engine=engine, xacro_args={"sim_slow": 1}, seed=3, parameters=NOISY
    )
    return sim.run(1.0, controller=controller, reference=reference)


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
@pytest.mark.parametrize("compile_function", [by_ctypes, by_numba])
def test_its_flights_are_those_of_the_same_controller_in_python(compile_function, engine):
    options = {"engine": engine, "reference": CIRCLE}
    expected = fly(Interpreted(), **options)
    assert np.ptp(expected.position[:, 2]) > 0
    assert fly(compile_function(), **options).table.tobytes() == expected.table.tobytes()


def test_a_function_of_a_shared_library_flies_alike(tmp_path):
    (tmp_path / "climb.c").write_text(
        "void climb(double t, double *x, double *r, double *data, double *speeds) {"
        "  for (int i = 0; i < 4; ++i)"
        "    speeds[i] = (data[1] + data[2] * (r[2] - x[2])) * (i % 2 ? -1 : 1);"
        "}"
    )
    command = ["g++", "-x", "c", "-shared", "-fPIC", "-o", "climb.so", "climb.c"]
    subprocess.run(command, cwd=str(tmp_path), check=True)
    library = ctypes.CDLL(str(tmp_path / "climb.so"))

    def climb(t, x, r, data, speeds):
        for i in range(4):
            speeds[i] = (data[1] + data[2] * (r[2] - x[2])) * (-1 if i % 2 else 1)

    compiled = Compiled(qc.CompiledController.prototype(("climb", library)))
    assert fly(compiled).table.tobytes() == fly(by_ctypes(climb)).table.tobytes()


@pytest.mark.parametrize("compile_function", [by_ctypes, by_numba])
def test_a_reference_in_python_gives_the_same_flight(compile_function):
    controller = compile_function()
    flights = [fly(controller, reference) for reference in (CIRCLE, lambda t: CIRCLE(t))]
    assert flights[0].table.tobytes() == flights[1].table.tobytes()


@pytest.mark.parametrize("engine", ["eigen", "lagrange"])
def test_a_study_has_a_row_of_it(engine):
    """Each flight begins with new data."""
    seeds = 1 if engine == "lagrange" else 3
    options = {"seeds": seeds, "duration": 1.0, "xacro_args": {"sim_slow": 1}, "engine": engine}
    if engine != "lagrange":
        options["parameters"] = NOISY
    found = qc.evaluate([Interpreted(), by_ctypes()], "step:time=0.2,dx=0,dz=0.1", **options)
    assert [row["failure"] for row in found.table] == [""] * 2 * seeds
    for name in ("rms_position", "max_position", "command_effort"):
        errors = [row[name] for row in found.table]
        assert errors[:seeds] == errors[seeds:]
        assert len(set(errors)) == seeds


def test_its_numbers_are_parameters(tmp_path, monkeypatch):
    pytest.importorskip("numba", reason="needs numba, which pip has")
    (tmp_path / "ours.py").write_text(
        "import numba, test_compiled_controllers as tests, quadcore as qc\n"
        "function = numba.cfunc(qc.CompiledController.signature)(tests.command)\n"
        "class Ours(tests.Compiled):\n"
        "    def __init__(self): super().__init__(function)\n"
    )
    monkeypatch.chdir(tmp_path)
    options = {"duration": 1.0, "xacro_args": {"sim_slow": 1}}
    found = qc.evaluate(["ours.py", "ours.py:Ours:gain=40"], "step:time=0.2,dx=0,dz=0.1", **options)
    errors = [row["rms_position"] for row in found.table]
    assert 0 < errors[1] < errors[0] - 1e-4


class Halved(Compiled):
    """A controller whose own call changes what the function commands."""

    def __call__(self, t, state, reference):
        return 0.5 * super().__call__(t, state, reference)


class Wrapping:
    """The same by an object that holds the controller."""

    def __init__(self, controller):
        self._controller = controller

    def __getattr__(self, name):
        return getattr(self._controller, name)

    def __call__(self, t, state, reference):
        return 0.5 * np.asarray(self._controller(t, state, reference))


@pytest.mark.parametrize("reference", [CIRCLE, lambda t: CIRCLE(t)])
def test_python_calls_what_changes_its_command(reference):
    halved = Halved(qc.CompiledController.prototype(command))
    expected = fly(Wrapping(Interpreted()), reference).table
    assert fly(halved, reference).table.tobytes() == expected.tobytes()
    assert fly(Wrapping(by_ctypes()), reference).table.tobytes() == expected.tobytes()
    assert fly(by_ctypes(), reference).table.tobytes() != expected.tobytes()


def test_the_core_does_not_call_what_an_injection_changes():
    wrapped = _Injection(by_ctypes(), 0)
    assert fly(wrapped).table.tobytes() != fly(by_ctypes()).table.tobytes()


def test_each_run_has_the_delay_and_begins_with_new_data():
    compiled, interpreted = by_ctypes(), Interpreted()
    compiled.delay = interpreted.delay = 0.004
    expected = fly(interpreted).table.tobytes()
    assert [fly(compiled).table.tobytes() for _ in range(2)] == [expected] * 2


def test_a_call_before_a_run_is_refused():
    with pytest.raises(qc.InputError, match=r"no run has begun\. Call reset\(simulation\) first"):
        by_ctypes()(0.0, None, CIRCLE(0.0))


@pytest.mark.parametrize(
    "function",
    [
        qc.CompiledController.prototype(),
        ctypes.PYFUNCTYPE(None, *qc.CompiledController.prototype._argtypes_)(command),
    ],
)
def test_a_function_that_the_core_cannot_call_is_refused(function):
    with pytest.raises(qc.InputError, match="is not compiled, or has no address"):
        qc.CompiledController(function)


def test_its_saturated_calls_count():
    def shout(t, state, reference, data, speeds):
        for i in range(4):
            speeds[i] = 2000.0

    class Shouting:
        def __call__(self, t, state, reference):
            return [2000.0] * 4

    controllers = [Shouting(), by_ctypes(shout)]
    found = qc.evaluate(controllers, "hover", duration=0.1, xacro_args={"sim_slow": 1})
    counts = [row["saturated"] for row in found.table]
    assert counts[0] == counts[1] > 0


@pytest.mark.parametrize("compile_function", [by_ctypes, by_numba])
def test_a_command_that_is_no_number_fails_the_flight(compile_function):
    def forget(t, state, reference, data, speeds):
        if t < 0.0995:
            command(t, state, reference, data, speeds)

    def forget_all(t, state, reference, data, speeds):
        speeds[0] = np.inf

    function = forget if compile_function is by_ctypes else forget_all
    with pytest.raises(qc.FlightError, match=r"controller returned .*nan.*Return 4 rotor speeds"):
        fly(compile_function(function))


def test_a_run_without_reference_is_refused():
    with pytest.raises(qc.InputError, match=r"a compiled function needs a reference\. Give one"):
        fly(by_ctypes(), reference=None)


def test_functions_with_other_arguments_are_refused():
    other = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(lambda t: t)
    with pytest.raises(qc.InputError, match=r"has other arguments than void\(float64, CPointer"):
        qc.CompiledController(other)
    undeclared = ctypes.CDLL(None).abs
    with pytest.raises(qc.InputError, match="has other arguments"):
        qc.CompiledController(undeclared)
    with pytest.raises(qc.InputError, match=r"is not a compiled function\. Compile it with numba"):
        qc.CompiledController(command)
    function = qc.CompiledController.prototype(command)
    with pytest.raises(qc.InputError, match=r"Give quadcore\.CompiledController\(function\)\.$"):
        fly(function)


@pytest.mark.parametrize("data", ["abc", [[1.0]], [1, "a"], None])
def test_data_that_are_no_list_of_numbers_are_refused(data):
    controller = by_ctypes()
    controller.make_data = lambda simulation: data
    with pytest.raises(qc.InputError, match=r"its make_data returned .*Return a list of numbers"):
        fly(controller)
