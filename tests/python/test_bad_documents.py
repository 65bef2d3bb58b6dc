"""Models, worlds and tags that would not be simulated as written are refused, with FILE:LINE."""

from __future__ import annotations

from pathlib import Path

import pytest
from faults import MODEL, assert_refused, fault, refusal
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import quadcore as qc

pytestmark = pytest.mark.usefixtures("toy")

MOUNT = '<link name="mount"/>'
PROPELLER = '<link name="propeller">'
MASS = '<mass value="0.01"/>'
INERTIA = '<inertia ixx="1e-5" ixy="0" ixz="0" iyy="1e-5" iyz="0" izz="2e-5"/>'
INERTIAL = f"""
    <inertial>
      {MASS}
      {INERTIA}
    </inertial>"""
SHAPE = '<cylinder radius="0.1" length="0.02"/>'
WELD = '<joint name="weld" type="fixed">'
ROTOR = '<joint name="rotor" type="continuous">'
TO_FRAME = '<parent link="frame"/>'
TO_MOUNT = '<parent link="mount"/>'
WELDED = '<child link="mount"/>'
TURNING = '<child link="propeller"/>'
LOOSE = '<link name="loose"/>'
ORIGIN = '<origin xyz="0 0 0.1"/>'
AXIS = '<axis xyz="0 0 1"/>'
DAMPING = '<dynamics damping="1e-6"/>'
SPRING = '<gazebo reference="rotor"><springStiffness>1</springStiffness></gazebo>'
K = "<rotorThrustCoeff>1e-5</rotorThrustCoeff>"
KP = "<kp>5e-4</kp>"
AIR = '<plugin name="air" filename="libaerodynamic_plugin.so">'
MOTOR = '<plugin name="motor" filename="libmotorpid_plugin.so">'
ODOMETRY = '<plugin name="odometry" filename="libodometry_plugin.so">'
RATE = "<rate>100</rate>"
AIR_SLOW = "<sim_slow>10</sim_slow>"
MOTOR_SLOW = "<sim_slow>10.0</sim_slow>"
GALE = '<plugin name="gale" filename="libaerodynamic_plugin.so">'


def mass(value):
    return f'<mass value="{value}"/>'


def inertia(ixx="1e-5", ixy="0", ixz="0", iyy="1e-5", iyz="0", izz="2e-5"):
    return f'<inertia ixx="{ixx}" ixy="{ixy}" ixz="{ixz}" iyy="{iyy}" iyz="{iyz}" izz="{izz}"/>'


def mount(mass, moment="0"):
    """The link on the fixed joint, with an inertial of its own."""
    moments = inertia(ixx=moment, iyy=moment, izz=moment)
    return f'<link name="mount"><inertial><mass value="{mass}"/>{moments}</inertial></link>'


def k(value):
    return f"<rotorThrustCoeff>{value}</rotorThrustCoeff>"


MODELS = {
    "a mass that is none": [
        fault(MASS, mass("-1"), "link 'propeller'", "mass -1", "Use a positive mass in kg."),
        fault(MASS, mass("nan"), "value of <mass> is 'nan'", "Write one finite number"),
        fault(MASS, mass("inf"), "value of <mass> is 'inf'", "Write one finite number"),
        fault(MASS, mass("1kg"), "value of <mass> is '1kg'", "Write one finite number"),
        fault(MASS, mass("0,01"), "value of <mass> is '0,01'", "Write one finite number"),
        fault(MASS, mass(""), "<mass> requires the attribute value"),
        fault(MASS, "<mass/>", "<mass> requires the attribute value"),
        fault(MASS, mass(1) + "\n" + mass(2), "a second <mass>", "Keep one of them", at=mass(2)),
        fault(MASS, mass("0"), "'propeller' moves", "no mass", "in kg, > 0", at=PROPELLER),
        fault(MASS, "", "<inertial> requires a <mass>. Add one", at="<inertial>\n      \n"),
        fault(INERTIAL, "", "'propeller' moves", "no <inertial>. Add one", at=PROPELLER),
    ],
    "a link on a fixed joint may be massless but not negative": [
        fault(MOUNT, mount("-1"), "link 'mount'", "mass -1", "Use a positive mass in kg."),
        fault(MOUNT, mount("nan"), "value of <mass> is 'nan'", "Write one finite number"),
        fault(MOUNT, mount("1", "-1"), "link 'mount'", "negative", "Write a positive"),
    ],
    "an inertia that no body can have": [
        fault(INERTIA, inertia(ixx="-1e-5"), "'propeller'", "negative", "Write a positive"),
        fault(INERTIA, inertia(ixy="2e-5"), "'propeller'", "negative", "Write a positive"),
        fault(INERTIA, inertia(izz="nan"), "izz of <inertia> is 'nan'", "one finite number"),
        fault(INERTIA, inertia(iyz="inf"), "iyz of <inertia> is 'inf'", "one finite number"),
        fault(INERTIA, '<inertia ixx="1"/>', "<inertia> requires the attribute iyy"),
        fault(INERTIA, inertia(ixx="0", izz="1e-5"), "moment", "must be positive", at=PROPELLER),
        fault(
            INERTIA,
            inertia(ixx="1e9"),
            "the principal moments of inertia 1e-05, 2e-05, 1000000000 kg m^2",
            "All of them must be positive and of comparable size.",
            at=PROPELLER,
        ),
        fault(
            INERTIA, inertia(ixx="0", iyy="0", izz="0"), "moment", "must be positive", at=PROPELLER
        ),
        fault(INERTIA, "", "<inertial> requires a <inertia>", at=f"<inertial>\n      {MASS}"),
    ],
    "a collision shape that is none": [
        fault(SHAPE, "<cone/>", "<cone> in <geometry>", "accepts box, cylinder, mesh, sphere"),
        fault(SHAPE, '<cylinder radius="1"/>', "<cylinder> requires the attribute length"),
        fault(SHAPE, '<cylinder radius="0" length="1"/>', "<cylinder>", "positive lengths in m"),
        fault(SHAPE, '<sphere radius="-1"/>', "<sphere>", "positive lengths in m"),
        fault(SHAPE, '<box size="1 1"/>', "size of <box> is '1 1'", "Write three finite numbers"),
        fault(SHAPE, "<box/>", "<box> requires the attribute size"),
        fault(SHAPE, "", "<geometry> must contain exactly one shape"),
        fault(SHAPE, SHAPE + '<sphere radius="1"/>', "<geometry> must contain exactly one shape"),
    ],
    "links and joints that make no tree": [
        fault(
            MOUNT, '<link name="frame"/>', "second link is named 'frame'", "toy.urdf:2", "another"
        ),
        fault(WELD, WELD.replace("weld", "rotor"), "second joint is named 'rotor'", at=ROTOR),
        fault(PROPELLER, "<link>", "<link> requires the attribute name"),
        fault('<robot name="toy">', "<robot>", "<robot> requires the attribute name"),
        fault(TO_MOUNT, "<parent/>", "<parent> requires the attribute link"),
        fault(TO_MOUNT, "", "<joint> requires a <parent>. Add one", at=ROTOR),
        fault(TURNING, "", "<joint> requires a <child>. Add one", at=ROTOR),
        fault(TO_MOUNT, '<parent link="mont"/>', "parent link 'mont'", "'mount'?", at=ROTOR),
        fault(TURNING, '<child link="hub"/>', "child link 'hub'", "Name a link", at=ROTOR),
        fault(WELDED, TURNING, "'propeller' is the child of joint 'rotor' and of 'weld'", at=ROTOR),
        fault(MOUNT, f"{MOUNT}\n{LOOSE}", "'loose' is a second root", "Connect it", at=LOOSE),
        fault(TO_FRAME, '<parent link="propeller"/>', "'weld' closes a loop", "a tree", at=WELD),
        fault(TO_FRAME, TO_MOUNT, "'weld' closes a loop", "make the model a tree", at=WELD),
        fault(MOUNT, f"{MOUNT}<lnk/>", "<lnk> in <robot>", "Did you mean 'link'?"),
        fault(MOUNT, '<link name="mount"><x/></link>', "<x> in <link>", "accepts collision"),
    ],
    "a joint that the engines do not model": [
        *(
            fault(ROTOR, ROTOR.replace("continuous", kind), f"'rotor' is of type '{kind}'", "Use")
            for kind in ("revolute", "prismatic", "floating", "planar", "hinge")
        ),
        fault(ROTOR, '<joint name="rotor">', "<joint> requires the attribute type"),
        fault(AXIS, '<axis xyz="0 0 0"/>', "joint 'rotor' has a zero axis", "such as 0 0 1"),
        fault(AXIS, '<axis xyz="up"/>', "xyz of <axis> is 'up'", "Write three finite numbers"),
        fault(ORIGIN, '<origin xyz="0 0"/>', "xyz of <origin> is '0 0'", "three finite numbers"),
        fault(ORIGIN, '<origin rpy="0 0 nan"/>', "rpy of <origin>", "three finite numbers"),
        fault(DAMPING, '<dynamics damping="-1"/>', "'rotor' has a negative damping", ">= 0"),
        fault(DAMPING, '<dynamics damping="soft"/>', "damping of <dynamics>", "finite number"),
        fault(DAMPING, '<dynamics friction="-0.1"/>', "'rotor' has a negative friction", ">= 0"),
        fault(DAMPING, '<limit lower="-1" upper="1"/>', "'rotor' has a limit lower", "Remove it"),
        fault(DAMPING, '<limit upper="1"/>', "'rotor' has a limit upper", "Remove it"),
        fault(DAMPING, '<mimic joint="weld"/>', "<mimic> in <joint>", "accepts axis, child"),
        fault(DAMPING, "<safety_controller/>", "<safety_controller> in <joint>", "accepts axis"),
        fault(DAMPING, "<calibration/>", "<calibration> in <joint>", "accepts axis, child"),
        fault(MOUNT, SPRING + MOUNT, "<springStiffness> is '1'", "Use 0"),
    ],
    "an attribute that nobody reads": [
        fault(DAMPING, '<dynamics dampin="1e-6"/>', "dampin", "damping"),
        fault(DAMPING, '<dynamics spring_stiffness="1"/>', "spring_stiffness", "damping"),
        fault(ORIGIN, '<origin xzy="0 0 0.1"/>', "xzy", "xyz"),
        fault("<inertial>\n      " + MASS, '<inertial mass="1">' + MASS, "mass of <inertial>"),
        fault("<collision>", '<collision size="1">', "size of <collision>", "accepts name"),
        fault("<geometry>", '<geometry scale="2">', "scale of <geometry>", "Remove it"),
        fault("<gazebo>", '<gazebo refernce="rotor">', "refernce", "Did you mean 'reference'?"),
        fault("<kp>", '<kp unit="N m s">', "unit of <kp>", "Remove it"),
        fault('<robot name="toy">', '<robot name="toy" nmae="x">', "nmae of <robot>", "'name'?"),
    ],
    "what would be passed over": [
        fault(AXIS, "<axis><xyz>0 0 1</xyz></axis>", "<xyz> in <axis>", "Remove it"),
        fault(ORIGIN, "<origin>0 0 0.1</origin>", "stray text '0 0 0.1' in <origin>", "Remove it"),
        fault(DAMPING, "<dynamics><damping>1</damping></dynamics>", "<damping> in <dynamics>"),
        fault(MASS, '<mass value="0.01">kg</mass>', "stray text 'kg' in <mass>", "Remove it"),
        fault(MASS, '<mass value="1"><value>2</value></mass>', "<value> in <mass>", "Remove it"),
        fault(DAMPING, 'dynamics damping="1"/>', "stray text 'dynamics", "in <joint>. Remove it"),
        fault(DAMPING, '<limit effort="nan"/>', "effort of <limit> is 'nan'", "finite number"),
        fault("<kp>5e-4", "<kp>5e-4<!-- a -->7", "the text of <kp> is interrupted", "comment out"),
    ],
    "XML that is malformed or dangerous": [
        fault('<robot name="toy">', '<robt name="toy">', "mismatched tag", at="</robot>"),
        fault("</gazebo>", "</gazeb>", "malformed XML", "mismatched tag"),
        fault("</robot>\n", "", "malformed XML", "no element found"),
        fault(MOUNT, '<link name="mount>', "malformed XML", at='<joint name="weld"'),
        fault(MOUNT, '<link name="mount" name="a"/>', "malformed XML", "duplicate attribute"),
        fault(MOUNT, "&lots;", "malformed XML", "undefined entity"),
        fault('<robot name="toy">', '<!DOCTYPE robot><robot name="toy">', "DOCTYPE", "Remove"),
        fault(
            '<robot name="toy">',
            '<!DOCTYPE robot [<!ENTITY x SYSTEM "file:///etc/hostname">]><robot name="&x;">',
            "DOCTYPE",
            "Remove them and write the values",
        ),
    ],
    "a tag that is wrong": [
        *(
            fault(K, k(value), f"'air': <rotorThrustCoeff> '{value}'", "Write a number in N s^2")
            for value in ("nan", "inf", "-inf", "1e999", "1e-5 N", "1e-5 1e-5", "0x1", "k", "")
        ),
        fault(K, k("-1"), "'air': <rotorThrustCoeff> '-1'", "Use a number >= 0"),
        fault(K, "", "'air': required tag <rotorThrustCoeff>", "Add", "in N s^2/rad^2", at=AIR),
        fault(KP, "", "'motor': required tag <kp>", "Add <kp>", "N m s/rad", at=MOTOR),
        fault(K, K + "\n" + k(2), "<rotorThrustCoeff>", "toy.urdf:31", "Keep one", at=k(2)),
        fault(K, "<rotorTrustCoeff>1</rotorTrustCoeff>", "'air'", "mean 'rotorThrustCoeff'?"),
        fault(KP, f"{KP}<kI>1</kI>", "'motor': unknown tag <kI>", "Did you mean 'ki'?"),
        fault(K, k("<b>1</b>"), "unknown tag <rotorThrustCoeff/b>", "mean 'rotorThrustCoeff'"),
        fault(K, f"{K}1", "stray text '1'", 'name="air"', "<tag>value</tag>", at=AIR),
        fault(AIR_SLOW, "<sim_slow>0</sim_slow>", "'air': <sim_slow> '0'", "Use a number > 0"),
        fault(K, f"{K}<rotorRadius>0</rotorRadius>", "<rotorRadius> '0'", "a number > 0"),
        fault(K, f"{K}<dragModel>none</dragModel>", "'none'", "Use appendix | chapter2"),
        fault(K, f"{K}<reactionTorque>-1</reactionTorque>", "'-1'", "Use thesis | opposing"),
        fault(K, f"{K}<publishTf>yes</publishTf>", "<publishTf> 'yes'", "Use true | false"),
        fault(KP, f"{KP}<iMax>-1</iMax>", "'motor': <iMax> '-1'", "a number >= 0"),
        fault(KP, f"{KP}<iMin>1</iMin>", "'motor': <iMin> '1'", "a number <= 0"),
        fault(KP, f"{KP}<kd>-1</kd>", "'motor': <kd> '-1'", "a number >= 0"),
        fault(KP, f"{KP}<maxVelocity>0</maxVelocity>", "<maxVelocity> '0'", "a number > 0"),
        fault(KP, f"{KP}<commandTimeout>off</commandTimeout>", "'off'", "number in s: > 0"),
        fault(RATE, "<rate>0</rate>", "'odometry': <rate> '0'", "a number > 0"),
        fault(RATE, f"{RATE}<updateRate>1</updateRate>", "<updateRate>", "is repeated", "Keep one"),
        fault(RATE, "<positionNoise>-1</positionNoise>", "<positionNoise> '-1'", ">= 0"),
        fault(RATE, "<twistFrame>drone</twistFrame>", "'drone'", "Use world | body"),
        fault(RATE, "<seed>-1</seed>", "'odometry': <seed> '-1'", "a number >= 0"),
        fault(RATE, "<seed>1.5</seed>", "<seed> is not a whole number.", at=ODOMETRY),
    ],
    "a tag that names what is not there": [
        fault(K, f"{K}<frameLink>fram</frameLink>", "'air': <frameLink> 'fram'", "'frame'?"),
        fault(K, f"{K}<frameLink>propeller</frameLink>", "'propeller'", "Name the root link"),
        fault(K, f"{K}<rotorJoints>rotr</rotorJoints>", "'rotr'", "Did you mean 'rotor'?"),
        fault(K, f"{K}<rotorJoints>weld</rotorJoints>", "'weld'", "The model has rotor"),
        fault(K, f"{K}<rotorJoints>rotor rotor</rotorJoints>", "'rotor' twice", "Name it once"),
        fault(K, f"{K}<rotorJoints> </rotorJoints>", "<rotorJoints>", "Name at least one"),
    ],
    "two sim slow that disagree": [
        fault(MOTOR_SLOW, "<sim_slow>8</sim_slow>", "10 in 'air'", "8 in 'motor'", "same value"),
        fault(MOTOR_SLOW, "", "10 in 'air'", "1 in 'motor' (default)", "same", at=AIR_SLOW),
        fault(AIR_SLOW, "", "1 in 'air' (default)", "10.0 in 'motor'", "same", at=MOTOR_SLOW),
    ],
    "a plugin element that is wrong": [
        fault(MOTOR, '<plugin filename="a.so">', "<plugin> requires the attribute name"),
        fault(MOTOR, '<plugin name="motor">', "<plugin> requires the attribute filename"),
        fault(
            MOTOR, MOTOR.replace("motor", "air", 1), "second plugin is named 'air'", "another name"
        ),
        fault(MOTOR, MOTOR.replace("lib", "../lib"), "'motor'", "is a path", "only the file name"),
        fault(
            MOTOR, MOTOR.replace("lib", "/lib/lib"), "'motor'", "is a path", "only the file name"
        ),
        fault("<gazebo>", f"{MOTOR}</plugin><gazebo>", "<plugin> stands outside", "Wrap it in"),
        fault(AIR, f"<static/>{AIR}", "<static> in <gazebo> is not supported", "accepts plugin"),
        fault(
            ODOMETRY,
            f"{GALE}{K}<rotorTorqueCoeff>0</rotorTorqueCoeff>{AIR_SLOW}</plugin>{ODOMETRY}",
            "plugin 'gale' reports the wrench 'thrust'",
            "Load only one of them",
        ),
    ],
}
WIND = "<linear_velocity>1 0 0</linear_velocity>"
GRAVITY = "<gravity>0 0 -9.8</gravity>"
STEP = "<max_step_size>0.001</max_step_size>"
UPDATE_RATE = "<real_time_update_rate>1000</real_time_update_rate>"
PHYSICS = '<physics type="ode">'
END = "    </physics>"
PLANE = (
    "<model><static>true</static><link><collision><geometry><plane><normal>0 0 1</normal></plane>"
    "</geometry></collision></link></model>"
)


def air(inside):
    return f"<atmosphere>{inside}</atmosphere>"


WORLDS = {
    "a value that is none": [
        fault(STEP, STEP.replace("0.001", "0"), "<max_step_size>", "Use a number >= 1e-09"),
        fault(STEP, STEP.replace("0.001", "-1"), "<max_step_size>", "Use a number >= 1e-09"),
        fault(STEP, STEP.replace("0.001", "1e-200"), "<max_step_size>", "a number >= 1e-09"),
        fault(STEP, STEP.replace("0.001", "1ms"), "<max_step_size> is '1ms'", "finite number"),
        fault(STEP, STEP.replace("0.001", "nan"), "<max_step_size> is 'nan'", "finite number"),
        fault(GRAVITY, "<gravity>-9.8</gravity>", "<gravity> is '-9.8'", "three finite numbers"),
        fault("<iters>50", "<iters>0", "<iters>", "whole number from 1 to"),
        fault("<iters>50", "<iters>2.5", "<iters>", "whole number from 1 to"),
        fault("<sor>1.3", "<sor>0", "<sor>", "Use a number > 0, <= 2"),
        fault("<sor>1.3", "<sor>2.5", "<sor>", "Use a number > 0, <= 2"),
        fault("<erp>0.2", "<erp>1.5", "<erp>", "Use a number >= 0, <= 1"),
        fault("<cfm>0", "<cfm>-1", "<cfm>", "Use a number >= 0"),
        fault("<type>quick", "<type>slow", "<type> is 'slow'", "Use quick or world"),
        fault(WIND, WIND.replace("1 0 0", "1 0 fast"), "'1 0 fast'", "three finite numbers"),
        fault(GRAVITY, air("<temperature>0</temperature>"), "<temperature>", "a number > 0"),
        fault(GRAVITY, air("<pressure>-1</pressure>"), "<pressure>", "Use a number >= 0"),
        fault(GRAVITY, air("<temperature_gradient>x</temperature_gradient>"), "finite number"),
    ],
    "an element that is not honoured": [
        *(
            fault(
                GRAVITY,
                f"<{name}/>",
                f"<{name}> in <world> is not supported",
                "accepts atmosphere, gravity",
            )
            for name in ("population",)
        ),
        fault(GRAVITY, "<plugin/>", "<plugin> requires the attribute name"),
        fault(GRAVITY, "<gravty>0 0 1</gravty>", "<gravty> in <world>", "Did you mean 'gravity'?"),
        fault(GRAVITY, '<atmosphere type="thick"/>', "atmosphere type 'thick'", "Use adiabatic"),
        fault(PHYSICS, '<physics type="bullet">', "physics type 'bullet'", "Use ode"),
        fault(STEP, "<max_contacts>2.5</max_contacts>", "<max_contacts> is out of range", "whole"),
        fault(
            "<sor>1.3</sor>",
            "<friction_model>cone_model</friction_model>",
            "<friction_model> is 'cone_model'",
            "Use pyramid_model",
        ),
        fault(WIND, "<angular_velocity/>", "<angular_velocity> in <wind>", "'linear_velocity'?"),
    ],
    "what would be passed over": [
        fault(PHYSICS, '<physics typ="ode">', "typ of <physics>", "Did you mean 'type'?"),
        fault(GRAVITY, "<gravity>0 0<!-- z --> -9.8</gravity>", "<gravity> is interrupted"),
    ],
    "what is said twice": [
        fault(
            UPDATE_RATE,
            f"{UPDATE_RATE}<updateRate>9</updateRate>",
            "<updateRate> sets",
            "Keep one",
        ),
        fault(
            END,
            f"{END}<physics:ode/>",
            "<physics:ode> sets the same value as <physics>",
            "Keep one of them",
        ),
        fault("</world>", "</world><world/>", "a second <world>", "Keep one of them"),
    ],
    "a model of a world that is not supported": [
        fault(END, END + PLANE.replace("0 0 1", "0 0 0"), "<normal> is zero", "Write a direction"),
        fault(END, END + PLANE.replace("plane", "torus"), "the shape <torus>", "Use box, sphere"),
    ],
    "XML that is malformed or dangerous": [
        fault("</physics>", "</physic>", "malformed XML", "mismatched tag"),
        fault('<sdf version="1.6">', "<!DOCTYPE sdf><sdf>", "DOCTYPE", "Remove"),
    ],
}
REFUSED = [
    pytest.param(name, broken, id=f"{group}: {broken}")
    for name, table in (("toy.urdf", MODELS), ("toy.world", WORLDS))
    for group, faults in table.items()
    for broken in faults
]


@pytest.mark.parametrize(("name", "broken"), REFUSED)
def test_a_document_with_a_fault_is_refused_at_its_line(name, broken):
    assert_refused(name, broken)


def test_the_documents_are_good_before_they_are_broken():
    simulation = qc.Simulation("toy.urdf", world="toy.world")
    assert simulation.rotor_count == 1
    assert simulation.warnings == []


def test_a_thin_disc_may_miss_the_triangle_inequality_by_rounding(toy):
    text = (toy / "toy.urdf").read_text()
    (toy / "toy.urdf").write_text(text.replace(INERTIA, inertia(izz="2.00000001e-5")))
    assert qc.Simulation("toy.urdf").mass == 1.01


def test_a_root_that_gazebo_would_pin_to_the_world(toy):
    text = (toy / "toy.urdf").read_text()
    (toy / "toy.urdf").write_text(text.replace('"frame"', '"world"'))
    message = refusal(qc.Simulation, "toy.urdf")
    assert message.startswith("toy.urdf:2: Gazebo fixes a root link named 'world'")


def test_elements_nested_without_end(toy):
    (toy / "toy.urdf").write_text("<robot name='deep'>" + "<a>" * 100000 + "</a>" * 100000)
    with pytest.raises(qc.InputError, match=r"^toy\.urdf:1: elements are nested deeper"):
        qc.Simulation("toy.urdf")


@settings(
    max_examples=200,
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(st.data())
def test_whatever_is_cut_or_doubled_is_flown_or_refused_with_its_place(toy, data):
    begin = data.draw(st.integers(0, len(MODEL)))
    end = data.draw(st.integers(begin, min(len(MODEL), begin + 60)))
    part = MODEL[begin:end] * data.draw(st.sampled_from([0, 2]))
    (toy / "toy.urdf").write_text(MODEL[:begin] + part + MODEL[end:])
    try:
        qc.Simulation("toy.urdf").step(3)
    except qc.InputError as error:
        assert str(error).startswith("toy.urdf:") and str(error).split(":")[1].isdigit()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("<launch/>", "toy.world:1: the outermost element is <launch>. Use <sdf>."),
        ("<sdf/>", "toy.world:1: <sdf> requires a <world>. Add one"),
        ("", "toy.world:1: "),
    ],
)
def test_a_file_that_is_no_world(toy, text, says):
    (toy / "toy.world").write_text(text)
    assert refusal(qc.Simulation, "toy.urdf", world="toy.world").startswith(says)


def test_a_plugin_that_is_not_found_names_every_folder_searched(toy, monkeypatch):
    for name in ("first", "second", "third"):
        (toy / name).mkdir()
    qc.load_plugin_path(str(toy / "first"))
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", f"{toy}/second::{toy}/third")
    folders = qc.plugin_folders()
    assert folders[0] == str(toy / "first")
    assert folders[-3:-1] == [f"{toy}/second", f"{toy}/third"]
    assert (Path(folders[-1]) / "libmotorpid_plugin.so").is_file()
    absent = fault(
        "libmotorpid_plugin.so",
        "libmotor.so",
        "'motor'",
        f"libmotor.so was not found in {', '.join(folders)}. Correct the file name or add its "
        "folder to QUADCORE_PLUGIN_PATH",
    )
    assert_refused("toy.urdf", absent)


def test_a_file_that_is_no_plugin_is_refused_by_what_it_lacks(toy, monkeypatch):
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", str(toy))
    (toy / "libtext.so").write_text("no library")
    text = fault("libodometry_plugin.so", "libtext.so", "'odometry'", "cannot be loaded", "Rebuild")
    assert_refused("toy.urdf", text)
    (library,) = Path(qc.plugin_folders()[-1]).glob("libquadcore.so*")
    core = fault("libtext.so", library.name, "is not a quadcore plugin", "REGISTER_PLUGIN")
    assert_refused("toy.urdf", core)


def test_a_folder_of_plugins_that_is_none():
    for path in ("nowhere", "toy.urdf"):
        assert refusal(qc.load_plugin_path, path).startswith(f"{path}: this is not a folder. Give")


def test_a_model_without_motor_cannot_be_commanded(toy):
    text = (toy / "toy.urdf").read_text()
    start, end = text.index(MOTOR), text.index(ODOMETRY)
    (toy / "toy.urdf").write_text(text[:start] + text[end:])
    simulation = qc.Simulation("toy.urdf", parameters={"air.sim_slow": 1})
    assert "Add libmotorpid_plugin.so" in refusal(simulation.command, [1])


def test_an_integral_gain_without_limits_is_warned_of():
    with pytest.warns(qc.QuadcoreWarning) as shown:
        simulation = qc.Simulation("toy.urdf", parameters={"motor.ki": 1})
    (warning,) = simulation.warnings
    assert warning.startswith("toy.urdf:35: plugin 'motor': <ki> has no effect while <iMax> and")
    assert [(str(w.message), w.filename) for w in shown] == [(warning, __file__)]
    assert qc.Simulation("toy.urdf", parameters={"motor.ki": 1, "motor.iMax": 1}).warnings == []


def test_effort_limits_of_a_joint_are_warned_of(toy):
    text = (toy / "toy.urdf").read_text()
    limit = '<limit effort="1" velocity="1"/>'
    (toy / "toy.urdf").write_text(text.replace('<dynamics damping="1e-6"/>', limit))
    with pytest.warns(qc.QuadcoreWarning):
        (warning,) = qc.Simulation("toy.urdf").warnings
    assert warning.startswith("toy.urdf:27: joint 'rotor': effort and velocity limits")
