"""Differences between two models, and between two flights, taken by themselves."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quadcore import Log
from quadcore._core import Document
from quadcore.studies import flight_differences
from quadcore.studies.compare.model_differences import (
    ABSENT,
    Difference,
    Fact,
    compare_documents,
    list_facts,
)
from quadcore.support.rotation import to_roll_pitch_yaw, unwrap_angles

BEFORE = """<robot name="r">
  <link name="a">
    <inertial><mass value="1.0"/><origin xyz="0 0  1"/></inertial>
    <visual><geometry><box size="1 1 1"/></geometry></visual>
    <collision><geometry><sphere radius="1"/></geometry></collision>
    <collision><geometry><sphere radius="2"/></geometry></collision>
  </link>
  <material name="red"/>
  <link name="b" kind="round"/>
  <joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>
  <gazebo>
    <plugin name="p" filename="x.so"><gain>1</gain><flag/><old>7</old></plugin>
    <plugin name="q" filename="q.so"><gain>1</gain></plugin>
  </gazebo>
</robot>
"""
AFTER = """<robot name="r">
  <link name="a">
    <inertial><mass value="1"/><origin xyz="0 0 1" rpy="0 0 1"/></inertial>
    <visual><geometry><box size="2 2 2"/></geometry></visual>
    <collision><geometry><sphere radius="1"/></geometry></collision>
    <collision><geometry><sphere radius="3"/></geometry></collision>
  </link>
  <material name="blue"/>
  <link name="b" kind="round"/>
  <joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>
  <gazebo reference="a"><mu1>0.5</mu1></gazebo>
  <gazebo>
    <plugin name="p" filename="x.so"><gain>two</gain><new/></plugin>
    <plugin name="s" filename="s.so"><gain>1</gain></plugin>
  </gazebo>
</robot>
"""


def document(text, name="b.urdf"):
    return Document(name, text)


def test_each_difference_is_reported_once_with_both_places():
    found = compare_documents(document(BEFORE, "a.urdf"), document(AFTER))
    assert found == [
        Difference("link a/collision[2]/geometry/sphere radius", "2", "3", "a.urdf:6", "b.urdf:6"),
        Difference("joint j", "continuous", "fixed", "a.urdf:10", "b.urdf:10"),
        Difference("p.gain", "1", "two", "a.urdf:12", "b.urdf:13"),
        Difference("p.flag", "present", ABSENT, "a.urdf:12", ""),
        Difference("p.old", "7", ABSENT, "a.urdf:12", ""),
        Difference("plugin q", "q.so", ABSENT, "a.urdf:13", ""),
        Difference("link a/inertial/origin rpy", ABSENT, "0 0 1", "", "b.urdf:3"),
        Difference("mu1", ABSENT, "0.5", "", "b.urdf:11"),
        Difference("p.new", ABSENT, "present", "", "b.urdf:13"),
        Difference("plugin s", ABSENT, "s.so", "", "b.urdf:14"),
    ]
    assert compare_documents(document(BEFORE), document(BEFORE)) == []


def test_facts_are_named_by_their_path_and_hang_on_their_link_joint_or_plugin():
    found = list_facts(document(BEFORE))
    assert found["link a"] == Fact("", "b.urdf:2", None)
    assert found["link a/inertial/origin xyz"] == Fact("0 0 1", "b.urdf:3", "link a")
    assert found["link b kind"] == Fact("round", "b.urdf:9", "link b")
    assert found["joint j/parent link"] == Fact("a", "b.urdf:10", "joint j")
    assert found["plugin p"] == Fact("x.so", "b.urdf:12", None)
    assert found["p.flag"] == Fact("", "b.urdf:12", "plugin p")
    assert list_facts(document("<robot><k><m>a \n b</m></k></robot>"))["k/m"].text == "a b"
    assert not any("visual" in name or "material" in name for name in found)
    assert "link a/inertial" not in found and "plugin p filename" not in found


def test_lines_come_from_the_files_that_a_document_was_made_of():
    text = "<robot>\n<link name='a'>\n<mass value='1'/>\n</link>\n</robot>\n"
    places = [("a.xacro", 5), ("b.xacro", 7), ("c.xacro", 9), ("b.xacro", 8), ("a.xacro", 6)]
    found = list_facts(Document("a.xacro", text, places))
    assert found["link a"].at == "b.xacro:7"
    assert found["link a/mass value"].at == "c.xacro:9"


def test_joints_in_another_order_are_reported_with_their_first_positions():
    def robot(*names):
        lines = [f'<joint name="{name}" type="t"/>' for name in names]
        return document("\n".join(["<robot>", *lines, "</robot>"]))

    assert compare_documents(robot("a", "b", "c"), robot("b", "a", "c")) == [
        Difference("order of the joints", "a b c", "b a c", "b.urdf:2", "b.urdf:2")
    ]
    links = [
        document(f"<robot><link name='{a}'/><link name='{b}'/></robot>") for a, b in ("ab", "ba")
    ]
    assert compare_documents(*links) == []
    # Only of those that both have.
    (gone,) = compare_documents(robot("x", "a", "b"), robot("a", "b"))
    assert gone == Difference("joint x", "t", ABSENT, "b.urdf:2", "")
    both = compare_documents(robot("x", "a", "b"), robot("b", "y", "a"))
    assert both[-1] == Difference("order of the joints", "a b", "b a", "b.urdf:3", "b.urdf:2")


@pytest.mark.parametrize(
    ("a", "b", "same"),
    [
        ("1 2", "1\n2", True),
        ("1 2", "1\n3", False),
        ("a b", "a\nb", True),
        ("1", "1.0", True),
        ("1e3 2", "1000  2", True),
        ("1", "2", False),
        ("x", "1", False),
    ],
)
def test_numbers_are_compared_as_numbers(a, b, same):
    first, second = (document(f"<robot><k>{text}</k></robot>") for text in (a, b))
    assert (compare_documents(first, second) == []) == same


def a_log(seed, times, rotors=3):
    """A smooth motion in which no two columns agree."""
    random = np.random.default_rng(seed)
    t = np.asarray(times)[:, None]
    columns = random.normal(size=14 - 4 - 1 + rotors) + random.normal(size=9 + rotors) * t
    start, rate = Rotation.from_quat(random.normal(size=4)), random.normal(size=3)
    attitude = np.array([(start * Rotation.from_rotvec(rate * x)).as_quat() for x in times])
    return Log(np.hstack([t, columns[:, :3], attitude, columns[:, 3:]]), {})


TIMES = np.array([0, 0.1, 0.3, 0.4, 0.7])


def test_differences_are_those_of_each_state_row_by_row():
    reference, log = a_log(1, TIMES), a_log(2, TIMES)
    found = flight_differences.compute_differences(reference, log)
    names = list(flight_differences.list_states(3))
    assert found.shape == (5, len(names)) == (5, 19)
    assert names[:4] == ["position", "attitude", "velocity", "rates"]
    assert names[16:] == ["j1", "j2", "j3"]
    units = dict(zip(names, flight_differences.list_states(3).values()))
    assert units["position"] == units["z"] == "m"
    assert units["attitude"] == units["yaw"] == units["roll"] == "rad"
    assert units["velocity"] == units["vy"] == "m/s"
    assert units["rates"] == units["wz"] == units["j2"] == "rad/s"

    apart = log.table - reference.table
    assert np.allclose(found[:, 0], np.sqrt((apart[:, 1:4] ** 2).sum(axis=1)), atol=1e-15)
    assert np.allclose(found[:, 2], np.sqrt((apart[:, 8:11] ** 2).sum(axis=1)), atol=1e-15)
    assert np.allclose(found[:, 3], np.sqrt((apart[:, 11:14] ** 2).sum(axis=1)), atol=1e-15)
    turns = [Rotation.from_quat(x.orientation) for x in (reference, log)]
    between = np.linalg.norm((turns[0].inv() * turns[1]).as_rotvec(), axis=1)
    assert np.allclose(found[:, 1], between, atol=1e-12)
    assert np.array_equal(found[:, 4:7], apart[:, 1:4])
    # Added to the angles of the reference they give the log's attitude, and by no way round.
    angles = to_roll_pitch_yaw(reference.orientation) + found[:, 7:10]
    there = Rotation.from_euler("ZYX", angles[:, ::-1])
    assert np.allclose((there.inv() * turns[1]).magnitude(), 0, atol=1e-7)
    straight = to_roll_pitch_yaw(log.orientation) - to_roll_pitch_yaw(reference.orientation)
    straight = np.abs(np.angle(np.exp(1j * straight))).sum(axis=1)
    assert np.all(np.abs(found[:, 7:10]).sum(axis=1) <= straight + 1e-12)
    assert np.abs(found[:, 7:10]).max() <= np.pi
    assert np.array_equal(found[:, 10:], apart[:, 8:])

    final, largest = flight_differences.compute_final_and_max(reference, log)
    assert np.array_equal(final, found[-1])
    assert np.array_equal(largest, np.abs(found).max(axis=0))


def test_angles_on_either_side_of_half_a_turn_are_near_each_other():
    """Rolls and yaws of 179 and -178 degrees differ by 3 degrees, not by 357."""

    def make_turned(axis, degrees):
        half = np.radians(degrees) / 2
        row = np.zeros(14)
        row[3 + axis], row[6] = np.sin(half), np.cos(half)
        table = np.vstack([np.insert(row, 0, t) for t in (0.0, 1.0)])
        return Log(table, {})

    for axis, name in ((0, "roll"), (2, "yaw")):
        column = list(flight_differences.list_states(1)).index(name)
        for before, after, apart in ((179, -178, 3), (-178, 179, -3), (10, 30, 20), (91, -91, 178)):
            final, largest = flight_differences.compute_final_and_max(
                make_turned(axis, before), make_turned(axis, after)
            )
            assert final[column] == pytest.approx(np.radians(apart), abs=1e-12)
            assert largest[column] == pytest.approx(np.radians(abs(apart)), abs=1e-12)


def make_pitched(*degrees):
    """A body that turns about its y axis."""
    rows = [Rotation.from_euler("Y", angle, degrees=True).as_quat() for angle in degrees]
    table = np.zeros((len(rows), 14))
    table[:, 0], table[:, 4:8] = np.arange(len(rows)), rows
    return Log(table, {})


def test_a_flip_of_the_angles_beyond_the_vertical_is_no_difference():
    """At 89 degrees of pitch roll and yaw are 0, at 91 they are 180."""
    below, beyond = make_pitched(60, 89), make_pitched(62, 91)
    found = dict(
        zip(
            flight_differences.list_states(0),
            np.degrees(flight_differences.compute_differences(below, beyond)).T,
        )
    )
    assert np.allclose(found["pitch"], 2)
    assert np.allclose(found["roll"], 0) and np.allclose(found["yaw"], 0)


def test_a_looping_is_drawn_without_a_jump():
    looping = np.arange(0, 730, 10.0)
    angles = np.degrees(unwrap_angles(make_pitched(*looping).rpy))
    assert np.allclose(angles, np.stack([0 * looping, looping, 0 * looping], axis=1), atol=1e-6)
    assert unwrap_angles(np.zeros((0, 3))).shape == (0, 3)


def test_the_sign_of_a_quaternion_makes_no_difference():
    reference, log = a_log(1, TIMES), a_log(2, TIMES)
    turned = Log(log.table.copy(), {})
    turned.table[:, 4:8] *= -1
    found = flight_differences.compute_differences(reference, turned)
    assert np.allclose(found, flight_differences.compute_differences(reference, log), atol=1e-12)


def test_only_the_time_that_both_cover_is_compared_and_a_reference_interpolated():
    whole = a_log(1, TIMES)
    longer = a_log(1, np.append(TIMES, 0.9))
    assert flight_differences.compute_differences(whole, longer).shape[0] == 5
    assert np.abs(flight_differences.compute_differences(longer, whole)).max() == 0
    # A time of the last row that rounding has put behind it counts.
    rounded = Log(whole.table.copy(), {})
    rounded.table[-1, 0] += 5e-10
    assert flight_differences.compute_differences(whole, rounded).shape[0] == 5

    dense = a_log(1, np.linspace(0, 0.7, 701))
    between = a_log(1, [0.05, 0.25, 0.5])
    found = flight_differences.compute_differences(dense, between)
    assert found.shape[0] == 3
    assert np.abs(found).max() < 1e-6
    coarse = flight_differences.compute_differences(a_log(1, [0, 0.7]), a_log(1, [0.2]))
    assert np.abs(coarse[:, [4, 5, 6, 10, 11, 12]]).max() < 1e-12  # straight lines stay
    assert 1e-4 < coarse[0, 1] < 0.1  # the turn lies on its chord, of unit length
    assert np.linalg.norm(
        flight_differences._interpolate(np.array([0.2]), a_log(1, [0, 0.7])).orientation
    ) == (pytest.approx(1, abs=1e-15))


def test_another_number_of_rotors_leaves_theirs_open():
    found = flight_differences.compute_differences(a_log(1, TIMES, 3), a_log(2, TIMES, 2))
    assert found.shape == (5, 19)
    assert np.isnan(found[:, 16:]).all() and np.isfinite(found[:, :16]).all()


def test_roll_pitch_yaw_are_the_angles_of_fixed_axes():
    random = np.random.default_rng(3)
    angles = random.uniform([-np.pi, -np.pi / 2, -np.pi], [np.pi, np.pi / 2, np.pi], (200, 3))
    quaternions = Rotation.from_euler("xyz", angles).as_quat()
    assert np.allclose(to_roll_pitch_yaw(quaternions), angles, rtol=0, atol=1e-7)
    assert np.allclose(to_roll_pitch_yaw(-quaternions.reshape(2, 100, 4)).reshape(-1, 3), angles)
    assert to_roll_pitch_yaw([0, 0, 0, 1]).tolist() == [0, 0, 0]
    # Rounding must not carry the sine of a vertical pitch beyond 1.
    half = np.sqrt(0.5) * (1 + 1e-15)
    for sign in (1, -1):
        assert to_roll_pitch_yaw([0, sign * half, 0, half])[1] == pytest.approx(sign * np.pi / 2)
