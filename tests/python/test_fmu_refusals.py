"""What FMUs refuse, and what they take for no change."""

import zipfile
from ctypes import byref

import pytest
from flights import HOVER, with_pilot
from imported import Imported

import quadcore as qc

pytest.importorskip("fmpy")


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
        {"controller": qc.laws.geometric()},
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
    with pytest.raises(qc.InputError, match=f"an FMU carries no {next(iter(options))}, ") as error:
        qc.export_fmu(tmp_path / "x.fmu", "quadrotor", **options)
    assert "\n" not in str(error.value)
    with pytest.raises(qc.InputError, match="None: no such file"):
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
        assert f"variable {name}: is fixed once the flight is initialised" in said
    instance.slave.reset()
    instance.set("spawn.z", 3.0)
    instance.initialise()
    assert instance.get("z") == [3.0]


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
        assert "give a whole multiple of the step of 0.001" in said
        assert (", 2^53 of them at most" in said) == (length > 0)


def test_variables_are_called_by_their_names_in_errors(instance):
    instance.slave.reset()
    for name, value, says in (
        ("seed", 1e30, "is no seed; give a whole number from 0 to 2147483647"),
        ("seed", 1.5, "is no seed"),
        ("seed", -1.0, "is no seed"),
        ("spawn.yaw", float("nan"), "is to be no finite number"),
        ("z", 1.0, "cannot be set to a number"),
        ("odom.x", 1.0, "cannot be set to a number"),
    ):
        said = refusal(instance, instance.slave.setReal, [instance.reference(name)], [value])
        assert f"variable {name}: {says}" in said


def test_a_start_that_is_no_time_is_refused(instance):
    for start in (float("nan"), float("inf")):
        said = refusal(instance, lambda at=start: instance.slave.setupExperiment(startTime=at))
        assert "the start time is no finite number" in said


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


def test_a_flag_of_a_saved_state_is_0_or_1(instance):
    """A command of zeros differs from none in a flag alone: it waits for the next step."""
    slave = instance.slave

    def saved():
        state = slave.getFMUstate()
        data = slave.serializeFMUstate(state)
        slave.freeFMUstate(state)
        return data

    before = saved()
    instance.command([0.0] * 4)
    after = saved()
    [at] = [k for k, (a, b) in enumerate(zip(before, after)) if a != b]
    damaged = after[:at] + b"\x02" + after[at + 1 :]
    said = refusal(instance, slave.deSerializeFMUstate, damaged)
    assert "the saved state is damaged; save it anew" in said


def test_the_folder_that_a_vehicle_lies_in_is_not_in_the_file(tmp_path):
    files = []
    for name in ("one", "another_one"):
        path = tmp_path / f"{name}.fmu"
        qc.export_fmu(path, with_pilot(tmp_path / name), engine="eigen")
        files.append(path.read_bytes())
    assert files[0] == files[1]
    with zipfile.ZipFile(str(path)) as archive:
        assert str(tmp_path) not in archive.read("resources/flight.yaml").decode()
