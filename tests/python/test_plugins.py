"""Plugins by others, good and bad, built outside the tree against the installed package."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from builds import build, build_once
from faults import MODEL, refusal
from flights import ENGINES
from printed import check_printed

import quadcore as qc
from quadcore.model.description import load_description

ROOT = Path(__file__).resolve().parents[2]
SIDE_FORCE = '<plugin name="push" filename="{}"><sideForce>{}</sideForce></plugin>'
FAULTY = '<plugin name="bad" filename="lib{}_plugin.so"><fault>{}</fault><after>{}</after></plugin>'
LINE = 2 + MODEL[: MODEL.index("<gazebo>")].count("\n")  # where with_plugin() puts it
AT = f"toy.urdf:{LINE}: plugin 'bad'"


@pytest.fixture(scope="module")
def side_force(tmp_path_factory):
    """Folder that holds the example's library."""
    return build_once(ROOT / "examples" / "side_force_plugin", tmp_path_factory)


@pytest.fixture(scope="module")
def faulty(tmp_path_factory):
    """Folder that holds bad plugins."""
    return build_once(ROOT / "tests" / "python" / "plugins", tmp_path_factory)


@pytest.fixture
def bad(toy, faulty, monkeypatch):
    """A function that returns a simulation with a bad plugin."""
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", str(faulty))

    def simulation(fault, after=0.0, variant="faulty", **options):
        with_plugin(FAULTY.format(variant, fault, after))
        return qc.Simulation("toy.urdf", **options)

    return simulation


def with_plugin(element: str) -> None:
    Path("toy.urdf").write_text(MODEL.replace("<gazebo>\n", f"<gazebo>\n{element}\n"))


def assert_pushed(engine: str, filename: str) -> None:
    """A vehicle that falls freely moves sideways with force / mass, and the log says why."""
    with_plugin(SIDE_FORCE.format(filename, 0.5))
    simulation = qc.Simulation("toy.urdf", engine=engine)
    log = simulation.run(0.5, wrenches=True)
    velocity = 0.5 / simulation.mass * log.time
    assert np.allclose(log.linear_velocity[:, 1], velocity, rtol=1e-12, atol=1e-15)
    assert not log.linear_velocity[:, 0].any()
    assert np.allclose(log.orientation, [0, 0, 0, 1], rtol=0, atol=1e-12)
    wrench = log.wrenches["side_force"]
    assert np.allclose(wrench, [0, 0.5, 0, 0, 0, 0], rtol=0, atol=1e-15)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_plugin_from_a_loaded_folder_pushes_the_vehicle(engine, side_force, toy):
    qc.load_plugin_path(str(side_force))
    assert_pushed(engine, "libside_force_plugin.so")


@pytest.mark.parametrize("engine", ENGINES)
def test_a_plugin_from_the_environments_folder_pushes_the_vehicle(
    engine, side_force, toy, monkeypatch
):
    # Under a name that no loaded folder has.
    shutil.copy(side_force / "libside_force_plugin.so", "libpush.so")
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", f"/nowhere:{toy}")
    assert_pushed(engine, "libpush.so")


def test_plugins_by_others_in_one_vehicle_keep_their_own_descriptors(
    side_force, faulty, toy, monkeypatch
):
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", f"{side_force}:{faulty}")
    side = SIDE_FORCE.format("libside_force_plugin.so", 0.5)
    with_plugin(side + FAULTY.format("faulty", "none", 0))
    wrenches = qc.Simulation("toy.urdf").run(0.01, wrenches=True).wrenches
    assert {"side_force", "fault"} < set(wrenches)
    assert (wrenches["side_force"][:, 1] == 0.5).all() and not wrenches["fault"].any()


def test_the_tags_of_a_plugin_by_others_are_listed_set_and_checked(side_force, toy, monkeypatch):
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", str(side_force))
    with_plugin(SIDE_FORCE.format("libside_force_plugin.so", 0.5))
    options = ["--set", "push.sideForce=2"]
    info = [sys.executable, "-m", "quadcore", "info", "toy.urdf"]
    listed = subprocess.run(info + options, capture_output=True, text=True, check=True).stdout
    (row,) = (line for line in listed.splitlines() if "sideForce" in line)
    assert "2" in row and "N" in row.split()
    with_plugin(SIDE_FORCE.format("libside_force_plugin.so", "1 kN"))
    message = refusal(qc.Simulation, "toy.urdf")
    assert message.startswith(f"toy.urdf:{LINE}: plugin 'push': <sideForce> '1 kN' is not a")


def test_the_cpp_example_flies_as_its_python_twin(tmp_path):
    model = ROOT / "tests" / "data" / "gazebo11" / "cases" / "A5_g9.81" / "model.urdf"
    # Compiled for this very processor, it must still lay out objects as the core does.
    flags = "-DCMAKE_CXX_FLAGS=-march=native -ffp-contract=off"
    program = build(ROOT / "examples" / "cpp", tmp_path, flags) / "fly"
    twin = ROOT / "examples" / "step_from_python.py"
    flown = [
        subprocess.run([*command, model], capture_output=True, text=True, check=True).stdout
        for command in ([program], [sys.executable, twin])
    ]
    assert flown[0] == flown[1]
    assert flown[0].startswith("t = 4.00 s, height 9.9")
    (tmp_path / "quadrotor.urdf").write_text(load_description("quadrotor", {}).text)
    command = [program, tmp_path / "quadrotor.urdf"]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    page = (ROOT / "docs" / "cpp.md").read_text()
    check_printed(page.split("$ ./fly quadrotor.urdf\n")[1].split("```")[0], printed, 1e-9)
    wrong = subprocess.run([program, twin], capture_output=True, text=True, check=False)
    assert wrong.returncode == 2
    assert wrong.stderr.startswith(f"error: {twin}:") and wrong.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("variant", "says"),
    [
        ("nameless", "failed to return its descriptor: what am I?"),
        ("undescribed", "has no descriptor. Add one and rebuild it."),
        ("uncreatable", "has no create in its descriptor. Add one and rebuild it."),
        ("outdated", "was built for force laws of old, but this quadcore has "),
        (
            "twofold",
            "has an invalid descriptor: its descriptor names 'fault' twice. Keep one of them.",
        ),
    ],
)
def test_a_library_that_does_not_fit_is_refused_by_plugin_and_file(bad, faulty, variant, says):
    message = refusal(bad, "none", variant=variant)
    assert message.startswith(f"{AT}: lib{variant}_plugin.so in {faulty} {says}")


def test_a_warning_of_a_plugin_that_is_no_text_can_be_shown(bad):
    with pytest.warns(qc.QuadcoreWarning, match=r"no text: \? \?\[31m"):
        bad("warning")


@pytest.fixture
def configure_changed(tmp_path):
    """Function that changes a source in a copy and returns the copy and the build folder."""
    changed, made = tmp_path / "changed", tmp_path / "made"
    shutil.copytree(ROOT / "cpp", changed / "cpp")
    shutil.copy(ROOT / "CMakeLists.txt", changed)

    def configure(source, before, after):
        text = (changed / "cpp" / source).read_text()
        assert before in text
        (changed / "cpp" / source).write_text(text.replace(before, after))
        words = ["cmake", "-S", changed, "-B", made, "-DQUADCORE_WITH_ROS=OFF"]
        subprocess.run(words, capture_output=True, check=True)
        return changed, made

    return configure


def test_tags_and_laws_of_shipped_plugins_are_no_part_of_the_plugin_interface(configure_changed):
    """So a plugin by others that was built before such a change loads after it."""
    interface = Path("include") / "quadcore" / "plugin_interface.hpp"
    installed = (Path(qc.cmake_prefix()) / interface).read_text()
    for source, tag in (
        ("plugins/aerodynamic/aerodynamic_plugin.cpp", "dragModel"),
        ("physics/laws/drag.hpp", "translationalDragCoeff"),
    ):
        _, made = configure_changed(source, f'"{tag}"', f'"{tag}OfTomorrow"')
        assert (made / "cpp" / "core" / interface).read_text() == installed


def test_a_plugin_built_from_a_changed_header_is_refused_by_name(
    configure_changed, tmp_path, toy, monkeypatch
):
    loads, wrench = "core/include/quadcore/plugin/loads.hpp", "struct Wrench {\n"
    changed, made = configure_changed(loads, wrench, f"{wrench}  double power = 0;\n")
    folders = [changed / "cpp" / "core" / "include", made / "cpp" / "core" / "include"]
    flags = "-DCMAKE_CXX_FLAGS=" + " ".join(f"-I{folder}" for folder in folders)
    folder = build(ROOT / "examples" / "side_force_plugin", tmp_path / "plugin", flags)
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", str(folder))
    shutil.move(folder / "libside_force_plugin.so", folder / "libchanged.so")  # loaded by no other
    with_plugin(SIDE_FORCE.format("libchanged.so", 0.5))
    message = refusal(qc.Simulation, "toy.urdf")
    named = re.escape(f"toy.urdf:{LINE}: plugin 'push': libchanged.so in {folder} was built for")
    says = (
        " plugin interface [0-9a-f]{16}, but this quadcore has [0-9a-f]{16}. "
        "Rebuild it against the installed quadcore."
    )
    assert re.fullmatch(named + says, message)


@pytest.mark.parametrize(
    ("fault", "says"),
    [
        ("create", "out of luck"),
        ("create_number", "an exception was thrown that is not a std::exception"),
        ("null", "its create() returned no plugin. Return one."),
        ("tag", "the plugin's table has no tag 'speed'"),
        ("state", "its state_size() is 1152921504606846976. Use at most 1000000."),
    ],
)
def test_a_plugin_that_fails_to_be_made_is_named_and_others_fly_on(bad, faulty, fault, says):
    other = bad("none")
    other.step(10)
    assert refusal(bad, fault) == f"{AT} ({faulty}/libfaulty_plugin.so): {says}"
    again = bad("none")
    again.step(20)
    other.step(10)
    assert repr(other.state) == repr(again.state)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("hook", ["update", "sense", "forces", "air", "carried"])
@pytest.mark.parametrize("thrown", ["", "_number"])
def test_a_plugin_that_throws_in_flight_is_named_and_the_flight_can_be_taken_up_again(
    bad, faulty, engine, hook, thrown
):
    what = "an exception was thrown that is not a std::exception" if thrown else "out of luck"
    named = f"plugin 'bad' ({faulty}/libfaulty_plugin.so): {what}"
    simulation = bad(hook + thrown, 0.0095, engine=engine)
    with pytest.raises(qc.FlightError) as failed:
        simulation.run(1)
    message = str(failed.value)
    assert message.startswith("the flight failed at t = 0.0") and message.endswith(named)
    assert 0.009 <= failed.value.time == simulation.time <= 0.011
    assert failed.value.log.time[-1] <= failed.value.time
    with pytest.raises(qc.FlightError, match="To continue, call reset, restore or set_state"):
        simulation.step()

    sound = bad("none", engine=engine)
    sound.step(9)
    simulation.reset()
    simulation.step(9)
    assert repr(simulation.state) == repr(sound.state)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("fault", "says"),
    [
        ("nan", "a force or torque is not a finite number"),
        ("infinity", "a force or torque is not a finite number"),
        ("air_nan", "the velocity of the air is not a finite number"),
        ("massless", "the carried body 'cargo' has no mass. Give a positive mass in kg."),
        ("rotor_force", "a load acts on rotor 99, but rotors are numbered from 0 and there are 1"),
        ("rotor_torque", "a load acts on rotor 99, but rotors are numbered from 0 and there are 1"),
        (
            "term_force",
            "a load refers to wrench term 5, but terms are numbered from 0 and the descriptor",
        ),
        (
            "term_torque",
            "a load refers to wrench term 1, but terms are numbered from 0 and the descriptor",
        ),
    ],
)
def test_a_plugin_whose_loads_make_no_sense_is_named_and_the_log_stays_whole(
    bad, faulty, engine, fault, says
):
    simulation = bad(fault, 0.0095, engine=engine)
    simulation.command([300])
    with pytest.raises(qc.FlightError) as failed:
        simulation.run(1, wrenches=True)
    assert f" s: plugin 'bad' ({faulty}/libfaulty_plugin.so): {says}" in str(failed.value)
    log = failed.value.log
    assert 10 <= len(log) <= 12
    sound = bad("none", engine=engine)
    sound.command([300])
    assert np.array_equal(log.table, sound.run(log.time[-1] + 1e-4).table)


@pytest.mark.parametrize("hook", ["sense", "forces"])
def test_a_plugin_that_throws_before_the_first_step_is_named(bad, faulty, hook):
    def begin():
        bad(hook).run(0.001)  # a log begins with the forces at time 0

    with pytest.raises(qc.QuadcoreError) as failed:
        begin()
    message = str(failed.value)
    assert f"plugin 'bad' ({faulty}/libfaulty_plugin.so): out of luck" in message
    assert "\n" not in message


def test_two_plugins_that_write_one_topic_are_refused_by_name(toy):
    with_plugin('<plugin name="first" filename="libodometry_plugin.so"/>')
    message = refusal(qc.Simulation, "toy.urdf")
    assert "plugin 'odometry' writes topic 'odom', which toy.urdf" in message
    assert message.endswith(f":{LINE}: plugin 'first' already writes. Keep one of the two.")


def test_commands_of_a_plugin_and_of_a_caller_are_reported(bad):
    simulation = bad("command")
    says = f"command() writes topic 'vel_cmd', which {AT} already writes. Keep one of the two."
    assert refusal(simulation.command, [300]) == says  # also before the plugin has written
    simulation.step()
    assert refusal(simulation.command, [300]) == says
    assert simulation.topic("vel_cmd")["count"] == 1
    simulation.step()  # nothing was changed
    with pytest.raises(qc.InputError, match=r"command\(\) writes topic 'vel_cmd'") as refused:
        simulation.run(0.1, commands=[[0, 300]])
    assert AT in str(refused.value)


def test_a_plugin_that_writes_a_topic_it_did_not_declare_ends_the_flight_by_name(bad):
    with pytest.raises(
        qc.FlightError, match="plugin 'bad' writes topic 'vel_cmd', which it did no"
    ):
        bad("undeclared").step()
