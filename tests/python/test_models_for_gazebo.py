"""Models made for Gazebo: what is only sensed is passed over, what is foreign is if asked."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from faults import MODEL, PUSHER, UNFELT, at, refusal

import quadcore as qc


def test_what_is_sensed_is_named_in_one_warning_with_its_lines(flown):
    with pytest.warns(qc.QuadcoreWarning, match="does not affect the motion"):
        simulation = flown(
            '<gazebo reference="propeller"><material>Red</material>\n'
            '<sensor name="eye" type="camera"><pose>1 2 3</pose><plugin filename="libx.so"/>'
            "</sensor></gazebo>\n"
            '<transmission name="a"><type>T</type></transmission>\n'
            '<properties kf="1e-9"/>\n'
            '<transmission name="b"/>\n'
            '<gazebo>\n<plugin name="odometry" filename="libgazebo_ros_p3d.so">of its own'
            "<ros><topic>x</topic></ros></plugin></gazebo>"
        )
    (warning,) = simulation.warnings
    first, second = (at("toy.urdf", f'<transmission name="{name}"') for name in "ab")
    assert warning == (
        f"{UNFELT}<transmission> ({first}, {second}), "
        f"<properties> ({at('toy.urdf', '<properties')}), "
        f"<sensor> ({at('toy.urdf', '<sensor')}), "
        f"libgazebo_ros_p3d.so ({at('toy.urdf', 'libgazebo_ros_p3d')})."
    )
    simulation.step(3)


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        ('<link name="frame">', '<link name="frame"><pose>0 0 1</pose>', "<pose>"),
        ("<collision>", "<collision><max_contacts>4</max_contacts>", "<max_contacts>"),
        ("<gazebo>", "<gazebo><provideFeedback>1</provideFeedback>", "<provideFeedback>"),
        ("<robot ", '<robot xsi:schemaLocation="a b" ', "attribute xsi:schemaLocation"),
        ('<link name="mount"/>', '<link name="mount"/>-->', "text in <robot>"),
    ],
)
def test_what_gazebo_passes_over_is_passed_over(toy, old, new, what):
    (toy / "toy.urdf").write_text(MODEL.replace(old, new, 1))
    with pytest.warns(qc.QuadcoreWarning):
        (warning,) = qc.Simulation("toy.urdf").warnings
    assert warning == f"{UNFELT}{what} ({at('toy.urdf', new)})."


def test_the_motion_is_that_without_what_is_sensed(flown):
    states = []
    for more in ("", '<gazebo reference="frame"><sensor name="eye" type="camera"/></gazebo>'):
        simulation = flown(more)
        simulation.command([300])
        simulation.step(200)
        states.append(simulation.state.copy())
    assert np.array_equal(states[0].position, states[1].position)
    assert np.array_equal(states[0].rotor_velocity, states[1].rotor_velocity)


def test_a_module_that_is_there_is_loaded_whatever_gazebo_makes_of_its_name(toy, monkeypatch):
    own = Path(qc.plugin_folders()[-1]) / "libodometry_plugin.so"
    shutil.copy(own, toy / "libgazebo_ros_p3d.so")
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", str(toy))
    (toy / "toy.urdf").write_text(MODEL.replace("libodometry_plugin.so", "libgazebo_ros_p3d.so"))
    simulation = qc.Simulation("toy.urdf")
    assert simulation.warnings == []
    assert simulation.plugins[2].path == str(toy / "libgazebo_ros_p3d.so")


def test_a_foreign_module_is_refused_with_its_remedy(flown):
    message = refusal(flown, f"\n<gazebo>{PUSHER}</gazebo>")
    assert message.startswith(f"{at('toy.urdf', 'pusher')}: plugin 'pusher': libpusher.so was not")
    assert message.endswith(" To simulate without it, use --ignore libpusher.so.")


@pytest.mark.parametrize("name", ["pusher", "libpusher.so"])
def test_a_foreign_module_is_left_out_by_its_name_or_file_whatever_it_holds(flown, name):
    simulation = flown(f"<gazebo>{PUSHER}</gazebo>", ignore=[name])
    assert simulation.ignored == [name]
    assert [plugin.name for plugin in simulation.plugins] == ["air", "motor", "odometry"]
    assert simulation.warnings == []


def test_one_file_name_leaves_out_every_plugin_of_that_module(flown):
    more = "".join(f"<gazebo>{PUSHER.replace('pusher', name, 1)}</gazebo>" for name in "ab")
    assert flown(more, ignore=["libpusher.so"]).ignored == ["libpusher.so"]
    assert "plugin 'b': libpusher.so was not found" in refusal(flown, more, ignore=["a"])


def test_two_plugins_may_share_a_name_if_one_is_left_out(flown):
    more = f"<gazebo>{PUSHER.replace('pusher', 'motor', 1)}</gazebo>"
    assert len(flown(more, ignore=["libpusher.so"]).plugins) == 3


def test_a_plugin_that_is_left_out_takes_no_values(flown):
    message = refusal(
        flown, f"<gazebo>{PUSHER}</gazebo>", ignore=["pusher"], parameters={"pusher.force": 1}
    )
    assert "the model has no plugin 'pusher'" in message


def test_a_misspelt_library_names_the_right_one(toy):
    (toy / "toy.urdf").write_text(MODEL.replace("libodometry_", "libodometri_"))
    message = refusal(qc.Simulation, "toy.urdf")
    assert " Did you mean 'libodometry_plugin.so'? Correct the file name" in message
    (toy / "toy.urdf").write_text(MODEL.replace("libodometry_plugin", "librotors_gazebo_thruster"))
    assert "Did you mean" not in refusal(qc.Simulation, "toy.urdf")


@pytest.mark.parametrize(
    ("old", "new", "name"),
    [
        ("</robot>", "<frame/></robot>", "frame"),
        ('<link name="mount"/>', '<link name="mount"><hook><a/></hook></link>', "hook"),
        ("<dynamics", "<calibration/><dynamics", "calibration"),
        ("<gazebo>", "<gazebo><static>1</static>", "static"),
    ],
)
def test_a_foreign_element_is_left_out_on_request(toy, old, new, name):
    (toy / "toy.urdf").write_text(MODEL.replace(old, new, 1))
    message = refusal(qc.Simulation, "toy.urdf")
    assert message.startswith(at("toy.urdf", f"<{name}")) and f"<{name}> in <" in message
    assert message.endswith(f" To simulate without it, use --ignore {name}.")
    assert qc.Simulation("toy.urdf", ignore=[name]).ignored == [name]


@pytest.mark.parametrize(
    ("old", "new", "name"),
    [
        ("<dynamics", '<mimic joint="weld"/><dynamics', "mimic"),
        ("<mass ", '<density value="1"/><mass ', "density"),
        ('type="continuous"', 'type="prismatic"', "rotor"),
        ('    <inertial>\n      <mass value="0.01"/>', "    <inertial>", "mass"),
    ],
)
def test_what_is_felt_is_refused_whatever_is_to_be_ignored(toy, old, new, name):
    (toy / "toy.urdf").write_text(MODEL.replace(old, new, 1))
    message = refusal(qc.Simulation, "toy.urdf")
    assert "--ignore" not in message
    assert refusal(qc.Simulation, "toy.urdf", ignore=[name]) == message


@pytest.mark.parametrize("name", ["pushr", "*", "", "link", "gazebo", "propeller"])
def test_an_unknown_name_is_refused_with_the_known_names(flown, name):
    message = refusal(flown, f"<gazebo>{PUSHER}</gazebo>", ignore=["pusher", name])
    assert message.startswith(
        f"ignore {name}: neither the model nor the world has anything of that name"
    )
    assert "libpusher.so" in message and "motor" in message
    assert ("Did you mean 'pusher'?" in message) == (name == "pushr")


@pytest.mark.parametrize("names", ["pusher", [1], [None]])
def test_names_to_ignore_are_a_list_of_texts(flown, names):
    assert "Give a list of names" in refusal(flown, ignore=names)


def test_an_inertia_that_breaks_the_triangle_inequality_warns_and_flies(toy):
    (toy / "toy.urdf").write_text(MODEL.replace('izz="0.04"', 'izz="0.0400002"'))
    for engine in ("gazebo11", "ode", "eigen"):
        with pytest.warns(qc.QuadcoreWarning, match="physically impossible inertia"):
            simulation = qc.Simulation("toy.urdf", engine=engine)
        (warning,) = simulation.warnings
        assert warning.startswith(f"{at('toy.urdf', '0.0400002')}: link 'frame' has a physically")
        simulation.command([300])
        simulation.step(100)
        assert simulation.state.rotor_velocity[0] > 10


def test_a_model_that_nothing_pushes_warns(toy):
    air = MODEL[MODEL.index('    <plugin name="air"') : MODEL.index('    <plugin name="motor"')]
    (toy / "toy.urdf").write_text(MODEL.replace(air, ""))
    with pytest.warns(qc.QuadcoreWarning, match="'toy' has no plugin that reports a force"):
        qc.Simulation("toy.urdf")


def test_a_model_without_rotors_warns(toy):
    (toy / "toy.urdf").write_text(
        '<robot name="stone"><link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" '
        'ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link></robot>'
    )
    with pytest.warns(qc.QuadcoreWarning, match="'stone' has no rotors, so it only falls"):
        qc.Simulation("toy.urdf")
