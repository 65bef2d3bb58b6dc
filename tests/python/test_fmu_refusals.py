"""What FMUs refuse, and what they take for no change."""

import zipfile
from ctypes import byref, c_char_p

import pytest
from flights import HOVER, with_pilot
from imported import Imported

import quadcore as qc

pytest.importorskip("fmpy")
from fmpy import fmi2


@pytest.fixture(scope="module")
def fmu(tmp_path_factory):
    path = tmp_path_factory.mktemp("fmu") / "quadrotor.fmu"
    qc.export_fmu(path, "quadrotor", engine="eigen")
    return path


@pytest.fixture
def instance(fmu, tmp_path):
    made = Imported(fmu, tmp_path)
    yield made
    made.close()


def refusal(instance, call, *arguments):
    """Give what the logger hears of a call that fails."""
    with pytest.raises(Exception, match="fmi2"):
        call(*arguments)
    return instance.said[-1][1]


@pytest.mark.parametrize(
    "options",
    [
        {"rotor_velocity": [100.0] * 4},
        {"controller": qc.controllers.geometric()},
        {"reference": qc.references.spiral()},
        {"on_reference": True},
        {"commands": HOVER},
        {"duration": 3.0},
        {"topics": ["odom"]},
        {"foo": 1},
    ],
    ids=lambda options: next(iter(options)),
)
def test_options_that_an_fmu_does_not_carry_are_refused_by_name(options, tmp_path):
    with pytest.raises(
        qc.InputError, match=f"an FMU has no option {next(iter(options))}: "
    ) as error:
        qc.export_fmu(tmp_path / "x.fmu", "quadrotor", **options)
    assert "\n" not in str(error.value)
    with pytest.raises(qc.InputError, match=r"model is None\. Give a name or a path"):
        qc.export_fmu(tmp_path / "x.fmu", None)
    assert list(tmp_path.iterdir()) == []


def test_what_is_not_tunable_is_fixed_in_flight(instance):
    instance.command(HOVER)
    instance.step()
    for name, value in (
        ("drone_plugin.dragModel", "chapter2"),
        ("odometry.publishTf", False),
        ("spawn.z", 3.0),
        ("seed", 7),
    ):
        said = refusal(instance, instance.set, name, value)
        assert f"variable {name}: it cannot change after the initialisation" in said
    instance.slave.reset()
    instance.set("spawn.z", 3.0)
    instance.initialise()
    assert instance.get("z") == [3.0]


def test_parameters_are_fixed_after_the_initialisation_and_not_before(fmu, tmp_path):
    """FMI 2.0, 4.2.4: in it, what begins exactly may be set."""
    instance = Imported(fmu, tmp_path, initialise=False)
    simulation = qc.Simulation(
        "quadrotor",
        "eigen",
        spawn=(0, 0, 3),
        seed=7,
        parameters={"drone_plugin.dragModel": "chapter2", "odometry.positionNoise": 0.1},
    )
    instance.slave.enterInitializationMode()
    assert instance.get("z") == [10.0]
    instance.set("spawn.z", 3.0)
    instance.set("seed", 7)
    instance.set("drone_plugin.dragModel", "chapter2")
    instance.set("odometry.positionNoise", 0.1)
    assert instance.get("z", "odom.x") == [3.0, simulation.topic("odom")["x"]]
    state = instance.slave.getFMUstate()
    instance.set("drone_plugin.rotorThrustCoeff", -1.0)
    said = refusal(instance, instance.slave.exitInitializationMode)
    assert "plugin 'drone_plugin': <rotorThrustCoeff>" in said
    said = refusal(instance, instance.step)
    assert "fmi2DoStep was called before the end of the initialisation." in said
    instance.slave.setFMUstate(state)
    instance.set("spawn.y", 1.0)  # the state is one of the initialisation
    instance.set("spawn.y", 0.0)
    instance.slave.exitInitializationMode()
    for fly in (instance, simulation):
        fly.command(HOVER)
    instance.step(0.1)
    simulation.step(100)
    assert instance.get("x", "z") == [simulation.state.position[0], simulation.state.position[2]]
    assert instance.get("odom.x") == [simulation.topic("odom")["x"]]
    assert "it cannot change after" in refusal(instance, instance.set, "spawn.z", 3.0)
    instance.close()


def test_a_parameter_set_to_the_value_that_it_has_is_no_change(tmp_path):
    """No second simulation is made, which would miss the file of the pilot's gains."""
    path = tmp_path / "piloted.fmu"
    qc.export_fmu(path, with_pilot(tmp_path / "here"), engine="eigen")
    instance = Imported(path, tmp_path / "fmu")
    [gains] = (tmp_path / "fmu/resources").glob("pilot.gains*")
    gains.unlink()
    tunable = [v for v in instance.variables.values() if v.variability == "tunable"]
    for variable in tunable:
        instance.set(variable.name, float(variable.start))
    instance.step()
    instance.set(tunable[0].name, 1.1 * float(tunable[0].start))
    assert "cannot be read" in refusal(instance, instance.step)
    instance.close()


def test_steps_beyond_all_counting_are_refused(instance):
    for length in (1e16, 1e30, float("inf"), float("nan")):
        said = refusal(instance, instance.slave.doStep, 0.0, length)
        assert "Use a whole multiple of the time step of 0.001" in said
        assert (", at most 2^53 of them" in said) == (length > 0)


def test_variables_are_called_by_their_names_in_errors(instance):
    instance.slave.reset()
    said = refusal(instance, instance.set, "seed", -1)
    assert "variable seed: the seed is invalid. Give a whole number from 0 to 2147483647" in said
    for name, value, says in (
        ("spawn.yaw", float("nan"), "the value is not a finite number"),
        ("z", 1.0, "it cannot be set to a number"),
        ("odom.x", 1.0, "it cannot be set to a number"),
    ):
        said = refusal(instance, instance.slave.setReal, [instance.reference(name)], [value])
        assert f"variable {name}: {says}" in said


def test_a_start_that_is_no_time_is_refused(instance):
    for start in (float("nan"), float("inf")):
        said = refusal(instance, lambda at=start: instance.slave.setupExperiment(startTime=at))
        assert "the start time is not a finite number" in said


def test_an_instance_needs_no_name(instance):
    slave, description = instance.slave, instance.description
    where = (instance.folder / "resources").as_uri().encode()
    callbacks = byref(instance.callbacks)
    for guid, is_made in ((description.guid.encode(), True), (b"another", False)):
        made = slave.fmi2Instantiate(None, 1, guid, where, callbacks, 0, 0)
        assert bool(made) == is_made
        if made:
            slave.fmi2FreeInstance(made)
    assert "the GUID is another" in instance.said[-1][1]


def test_a_variable_is_asked_for_by_its_type(instance):
    """Reading another would round it, or make a text of it, without a word."""
    slave, types = instance.slave, {"Real": "z", "Integer": "seed"}
    types.update({"Boolean": "odometry.publishTf", "String": "drone_plugin.dragModel"})
    calls = {"Real": slave.getReal, "Integer": slave.getInteger, "String": slave.getString}
    calls["Boolean"] = slave.getBoolean
    for asked, call in calls.items():
        for held, name in types.items():
            if asked == held:
                call([instance.reference(name)])
            else:
                said = refusal(instance, call, [instance.reference(name)])
                assert f"variable {name}: its type is {held}, not {asked}. Call" in said
        assert "no variable has the value reference 99999" in refusal(instance, call, [99999])
    slave.reset()
    said = refusal(instance, slave.setReal, [instance.reference("seed")], [3.0])
    assert "variable seed: its type is Integer, not Real" in said
    reference = byref(fmi2.fmi2ValueReference(instance.reference("drone_plugin.dragModel")))
    nothing = (c_char_p * 1)(None)
    said = refusal(instance, slave.fmi2SetString, slave.component, reference, 1, nothing)
    assert "variable drone_plugin.dragModel: the value is a null pointer. Give a text." in said


def test_an_importer_may_have_no_logger(instance):
    """No logger, or no functions at all: what is wrong is still a status."""
    slave, description = instance.slave, instance.description
    where = (instance.folder / "resources").as_uri().encode()
    guid = description.guid.encode()
    for callbacks in (None, byref(fmi2.fmi2CallbackFunctions())):
        for arguments in ((guid, None), (None, where), (b"another", where)):
            assert not slave.fmi2Instantiate(b"one", 1, *arguments, callbacks, 0, 0)
        made = slave.fmi2Instantiate(b"one", 1, guid, where, callbacks, 0, 0)
        with pytest.raises(Exception, match="fmi2DoStep"):
            slave.fmi2DoStep(made, 0.0, 0.001, 0)
        slave.fmi2FreeInstance(made)
    with pytest.raises(Exception, match="fmi2ExitInitializationMode"):
        slave.fmi2ExitInitializationMode(None)
    slave.fmi2FreeInstance(None)


def test_events_of_a_scenario_may_come_whenever_the_importer_flies(tmp_path, recwarn):
    """Nobody knows when it ends."""
    late, path = tmp_path / "late.yaml", tmp_path / "late.fmu"
    late.write_text("events:\n  - {at: 1000, weaken: 2, to: 0.95}\n")
    qc.export_fmu(path, "quadrotor", engine="eigen", scenario=late)
    assert [str(warning.message) for warning in recwarn] == []
    instance = Imported(path, tmp_path / "fmu")
    names = ("fault.effectiveness", "fault.effectiveness_tag")  # of the topic, and of the plugin
    assert [instance.variables[name].causality for name in names] == ["input", "parameter"]
    instance.step()
    instance.close()


def test_a_flag_of_a_saved_state_is_0_or_1(instance):
    """A command of zeros differs from none in a flag alone: it waits for the next step."""
    slave = instance.slave

    def save_state():
        state = slave.getFMUstate()
        data = slave.serializeFMUstate(state)
        slave.freeFMUstate(state)
        return data

    before = save_state()
    instance.command([0.0] * 4)
    after = save_state()
    [at] = [k for k, (a, b) in enumerate(zip(before, after)) if a != b]
    damaged = after[:at] + b"\x02" + after[at + 1 :]
    said = refusal(instance, slave.deSerializeFMUstate, damaged)
    assert "the saved state is damaged. Save it again." in said


def test_the_folder_that_a_vehicle_lies_in_is_not_in_the_file(tmp_path):
    files = []
    for name in ("one", "another_one"):
        path = tmp_path / f"{name}.fmu"
        qc.export_fmu(path, with_pilot(tmp_path / name), engine="eigen")
        files.append(path.read_bytes())
    assert files[0] == files[1]
    with zipfile.ZipFile(str(path)) as archive:
        assert str(tmp_path) not in archive.read("resources/flight.yaml").decode()
