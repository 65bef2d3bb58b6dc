"""Models that Gazebo would mangle in silence are refused, with FILE:LINE and what to write."""

from __future__ import annotations

import pytest
from faults import assert_refused, fault, refusal
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import quadcore as qc

pytestmark = pytest.mark.usefixtures("toy")

FRAME = '<link name="frame">'
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


def mass(value):
    return f'<mass value="{value}"/>'


def inertia(ixx="1e-5", ixy="0", ixz="0", iyy="1e-5", iyz="0", izz="2e-5"):
    return f'<inertia ixx="{ixx}" ixy="{ixy}" ixz="{ixz}" iyy="{iyy}" iyz="{iyz}" izz="{izz}"/>'


def mount(mass, moment="0"):
    """The link on the fixed joint, with an inertial of its own."""
    moments = inertia(ixx=moment, iyy=moment, izz=moment)
    return f'<link name="mount"><inertial><mass value="{mass}"/>{moments}</inertial></link>'


def test_the_documents_are_good_before_they_are_broken():
    simulation = qc.Simulation("toy.urdf", world="toy.world")
    assert simulation.rotor_count == 1
    assert simulation.warnings == []


@pytest.mark.parametrize(
    "broken",
    [
        fault(MASS, mass("-1"), "link 'propeller'", "mass -1", "write a mass in kg, > 0"),
        fault(MASS, mass("nan"), "value of <mass> is 'nan'", "write one finite number"),
        fault(MASS, mass("inf"), "value of <mass> is 'inf'", "write one finite number"),
        fault(MASS, mass("1kg"), "value of <mass> is '1kg'", "write one finite number"),
        fault(MASS, mass("0,01"), "value of <mass> is '0,01'", "write one finite number"),
        fault(MASS, mass(""), '<mass> needs the attribute value="..."'),
        fault(MASS, "<mass/>", '<mass> needs the attribute value="..."'),
        fault(MASS, mass(1) + "\n" + mass(2), "a second <mass>", "keep one of them", at=mass(2)),
        fault(MASS, mass("0"), "'propeller' moves", "no mass", "in kg, > 0", at=PROPELLER),
        fault(MASS, "", "<inertial> needs a <mass>; add one", at="<inertial>\n      \n"),
        fault(INERTIAL, "", "'propeller' moves", "no <inertial>; add one", at=PROPELLER),
    ],
    ids=str,
)
def test_a_mass_that_is_none(broken):
    assert_refused("toy.urdf", broken)


@pytest.mark.parametrize(
    "broken",
    [
        fault(MOUNT, mount("-1"), "link 'mount'", "mass -1", "write a mass in kg, > 0"),
        fault(MOUNT, mount("nan"), "value of <mass> is 'nan'", "write one finite number"),
        fault(MOUNT, mount("1", "-1"), "link 'mount'", "negative", "write a positive"),
    ],
    ids=str,
)
def test_a_link_on_a_fixed_joint_may_be_massless_but_not_negative(broken):
    assert_refused("toy.urdf", broken)


@pytest.mark.parametrize(
    "broken",
    [
        fault(INERTIA, inertia(ixx="-1e-5"), "'propeller'", "negative", "write a positive"),
        fault(INERTIA, inertia(ixy="2e-5"), "'propeller'", "negative", "write a positive"),
        fault(INERTIA, inertia(izz="nan"), "izz of <inertia> is 'nan'", "one finite number"),
        fault(INERTIA, inertia(iyz="inf"), "iyz of <inertia> is 'inf'", "one finite number"),
        fault(INERTIA, '<inertia ixx="1"/>', '<inertia> needs the attribute iyy="..."'),
        fault(INERTIA, inertia(ixx="0", izz="1e-5"), "moment", "> 0", at=PROPELLER),
        fault(
            INERTIA,
            inertia(ixx="1e9"),
            "the principal moments of inertia 1e-05, 2e-05, 1000000000 kg m^2",
            "none of them next to nothing beside another",
            at=PROPELLER,
        ),
        fault(INERTIA, inertia(ixx="0", iyy="0", izz="0"), "moment", "> 0", at=PROPELLER),
        fault(INERTIA, "", "<inertial> needs a <inertia>", at=f"<inertial>\n      {MASS}"),
    ],
    ids=str,
)
def test_an_inertia_that_no_body_can_have(broken):
    assert_refused("toy.urdf", broken)


def test_a_thin_disc_may_miss_the_triangle_inequality_by_rounding(toy):
    text = (toy / "toy.urdf").read_text()
    (toy / "toy.urdf").write_text(text.replace(INERTIA, inertia(izz="2.00000001e-5")))
    assert qc.Simulation("toy.urdf").mass == 1.01


@pytest.mark.parametrize(
    "broken",
    [
        fault(SHAPE, "<cone/>", "<cone> in <geometry>", "takes box, cylinder, mesh, sphere"),
        fault(SHAPE, '<cylinder radius="1"/>', '<cylinder> needs the attribute length="..."'),
        fault(SHAPE, '<cylinder radius="0" length="1"/>', "<cylinder>", "lengths in m, > 0"),
        fault(SHAPE, '<sphere radius="-1"/>', "<sphere>", "lengths in m, > 0"),
        fault(SHAPE, '<box size="1 1"/>', "size of <box> is '1 1'", "write three finite numbers"),
        fault(SHAPE, "<box/>", '<box> needs the attribute size="..."'),
        fault(SHAPE, "", "<geometry> takes exactly one shape"),
        fault(SHAPE, SHAPE + '<sphere radius="1"/>', "<geometry> takes exactly one shape"),
    ],
    ids=str,
)
def test_a_collision_shape_that_is_none(broken):
    assert_refused("toy.urdf", broken)


WELD = '<joint name="weld" type="fixed">'
ROTOR = '<joint name="rotor" type="continuous">'
TO_FRAME = '<parent link="frame"/>'
TO_MOUNT = '<parent link="mount"/>'
WELDED = '<child link="mount"/>'
TURNING = '<child link="propeller"/>'
LOOSE = '<link name="loose"/>'


@pytest.mark.parametrize(
    "broken",
    [
        fault(MOUNT, '<link name="frame"/>', "second link named 'frame'", "toy.urdf:2", "another"),
        fault(WELD, WELD.replace("weld", "rotor"), "second joint named 'rotor'", at=ROTOR),
        fault(PROPELLER, "<link>", '<link> needs the attribute name="..."'),
        fault('<robot name="toy">', "<robot>", '<robot> needs the attribute name="..."'),
        fault(TO_MOUNT, "<parent/>", '<parent> needs the attribute link="..."'),
        fault(TO_MOUNT, "", "<joint> needs a <parent>; add one", at=ROTOR),
        fault(TURNING, "", "<joint> needs a <child>; add one", at=ROTOR),
        fault(TO_MOUNT, '<parent link="mont"/>', "parent link 'mont'", "'mount'?", at=ROTOR),
        fault(TURNING, '<child link="hub"/>', "child link 'hub'", "name a link", at=ROTOR),
        fault(WELDED, TURNING, "'propeller' hangs on joint 'rotor' and on 'weld'", at=ROTOR),
        fault(MOUNT, f"{MOUNT}\n{LOOSE}", "'loose' is a second root", "connect it", at=LOOSE),
        fault(TO_FRAME, '<parent link="propeller"/>', "'weld' closes a loop", "a tree", at=WELD),
        fault(TO_FRAME, TO_MOUNT, "'weld' closes a loop", "must be a tree", at=WELD),
        fault(MOUNT, f"{MOUNT}<lnk/>", "<lnk> in <robot>", "did you mean 'link'?"),
        fault(MOUNT, '<link name="mount"><x/></link>', "<x> in <link>", "takes collision"),
    ],
    ids=str,
)
def test_links_and_joints_that_make_no_tree(broken):
    assert_refused("toy.urdf", broken)


def test_a_root_that_gazebo_would_pin_to_the_world(toy):
    text = (toy / "toy.urdf").read_text()
    (toy / "toy.urdf").write_text(text.replace('"frame"', '"world"'))
    message = refusal(qc.Simulation, "toy.urdf")
    assert message.startswith("toy.urdf:2: Gazebo pins a root link named 'world'")


ORIGIN = '<origin xyz="0 0 0.1"/>'
AXIS = '<axis xyz="0 0 1"/>'
DAMPING = '<dynamics damping="1e-6"/>'
SPRING = '<gazebo reference="rotor"><springStiffness>1</springStiffness></gazebo>'


@pytest.mark.parametrize(
    "broken",
    [
        *(
            fault(ROTOR, ROTOR.replace("continuous", kind), f"'rotor' is of type '{kind}'", "write")
            for kind in ("revolute", "prismatic", "floating", "planar", "hinge")
        ),
        fault(ROTOR, '<joint name="rotor">', '<joint> needs the attribute type="..."'),
        fault(AXIS, '<axis xyz="0 0 0"/>', "joint 'rotor' has no axis", "such as 0 0 1"),
        fault(AXIS, '<axis xyz="up"/>', "xyz of <axis> is 'up'", "write three finite numbers"),
        fault(ORIGIN, '<origin xyz="0 0"/>', "xyz of <origin> is '0 0'", "three finite numbers"),
        fault(ORIGIN, '<origin rpy="0 0 nan"/>', "rpy of <origin>", "three finite numbers"),
        fault(DAMPING, '<dynamics damping="-1"/>', "'rotor' has a negative damping", ">= 0"),
        fault(DAMPING, '<dynamics damping="soft"/>', "damping of <dynamics>", "finite number"),
        fault(DAMPING, '<dynamics friction="-0.1"/>', "'rotor' has a negative friction", ">= 0"),
        fault(DAMPING, '<limit lower="-1" upper="1"/>', "'rotor' has a limit lower", "remove it"),
        fault(DAMPING, '<limit upper="1"/>', "'rotor' has a limit upper", "remove it"),
        fault(DAMPING, '<mimic joint="weld"/>', "<mimic> in <joint>", "takes axis, child"),
        fault(DAMPING, "<safety_controller/>", "<safety_controller> in <joint>", "takes axis"),
        fault(DAMPING, "<calibration/>", "<calibration> in <joint>", "takes axis, child"),
        fault(MOUNT, SPRING + MOUNT, "<springStiffness> is '1'", "write 0"),
    ],
    ids=str,
)
def test_a_joint_that_the_engines_do_not_model(broken):
    assert_refused("toy.urdf", broken)


@pytest.mark.parametrize(
    "broken",
    [
        fault(DAMPING, '<dynamics dampin="1e-6"/>', "dampin", "damping"),
        fault(DAMPING, '<dynamics spring_stiffness="1"/>', "spring_stiffness", "damping"),
        fault(ORIGIN, '<origin xzy="0 0 0.1"/>', "xzy", "xyz"),
        fault("<inertial>\n      " + MASS, '<inertial mass="1">' + MASS, "mass of <inertial>"),
        fault("<collision>", '<collision size="1">', "size of <collision>", "takes name"),
        fault("<geometry>", '<geometry scale="2">', "scale of <geometry>", "remove it"),
        fault("<gazebo>", '<gazebo refernce="rotor">', "refernce", "did you mean 'reference'?"),
        fault("<kp>", '<kp unit="N m s">', "unit of <kp>", "remove it"),
        fault('<robot name="toy">', '<robot name="toy" nmae="x">', "nmae of <robot>", "'name'?"),
    ],
    ids=str,
)
def test_an_attribute_that_nobody_reads(broken):
    assert_refused("toy.urdf", broken)


@pytest.mark.parametrize(
    "broken",
    [
        fault(AXIS, "<axis><xyz>0 0 1</xyz></axis>", "<xyz> in <axis>", "remove it"),
        fault(ORIGIN, "<origin>0 0 0.1</origin>", "stray text '0 0 0.1' in <origin>", "remove it"),
        fault(DAMPING, "<dynamics><damping>1</damping></dynamics>", "<damping> in <dynamics>"),
        fault(MASS, '<mass value="0.01">kg</mass>', "stray text 'kg' in <mass>", "remove it"),
        fault(MASS, '<mass value="1"><value>2</value></mass>', "<value> in <mass>", "remove it"),
        fault(DAMPING, 'dynamics damping="1"/>', "stray text 'dynamics", "in <joint>; remove it"),
        fault(DAMPING, '<limit effort="nan"/>', "effort of <limit> is 'nan'", "finite number"),
        fault("<kp>5e-4", "<kp>5e-4<!-- a -->7", "the text of <kp> is in pieces", "comment out"),
    ],
    ids=str,
)
def test_what_would_be_passed_over(broken):
    assert_refused("toy.urdf", broken)


@pytest.mark.parametrize(
    "broken",
    [
        fault('<robot name="toy">', '<robt name="toy">', "mismatched tag", at="</robot>"),
        fault("</gazebo>", "</gazeb>", "malformed XML", "mismatched tag"),
        fault("</robot>\n", "", "malformed XML", "no element found"),
        fault(MOUNT, '<link name="mount>', "malformed XML", at='<joint name="weld"'),
        fault(MOUNT, '<link name="mount" name="a"/>', "malformed XML", "duplicate attribute"),
        fault(MOUNT, "&lots;", "malformed XML", "undefined entity"),
        fault('<robot name="toy">', '<!DOCTYPE robot><robot name="toy">', "DOCTYPE", "remove"),
        fault(
            '<robot name="toy">',
            '<!DOCTYPE robot [<!ENTITY x SYSTEM "file:///etc/hostname">]><robot name="&x;">',
            "DOCTYPE",
            "remove them and write the values out",
        ),
    ],
    ids=str,
)
def test_xml_that_is_malformed_or_dangerous(broken):
    assert_refused("toy.urdf", broken)


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
    from faults import MODEL

    begin = data.draw(st.integers(0, len(MODEL)))
    end = data.draw(st.integers(begin, min(len(MODEL), begin + 60)))
    part = MODEL[begin:end] * data.draw(st.sampled_from([0, 2]))
    (toy / "toy.urdf").write_text(MODEL[:begin] + part + MODEL[end:])
    try:
        qc.Simulation("toy.urdf").step(3)
    except qc.InputError as error:
        assert str(error).startswith("toy.urdf:") and str(error).split(":")[1].isdigit()
