"""Worlds that would not be flown as they are written are refused."""

from __future__ import annotations

import pytest
from faults import assert_refused, fault

pytestmark = pytest.mark.usefixtures("toy")

WIND = "<linear_velocity>1 0 0</linear_velocity>"
GRAVITY = "<gravity>0 0 -9.8</gravity>"
STEP = "<max_step_size>0.001</max_step_size>"
RATE = "<real_time_update_rate>1000</real_time_update_rate>"
PHYSICS = '<physics type="ode">'
END = "    </physics>"


def air(inside):
    return f"<atmosphere>{inside}</atmosphere>"


@pytest.mark.parametrize(
    "broken",
    [
        fault(STEP, STEP.replace("0.001", "0"), "<max_step_size>", "write a number >= 1e-09"),
        fault(STEP, STEP.replace("0.001", "-1"), "<max_step_size>", "write a number >= 1e-09"),
        fault(STEP, STEP.replace("0.001", "1e-200"), "<max_step_size>", "a number >= 1e-09"),
        fault(STEP, STEP.replace("0.001", "1ms"), "<max_step_size> is '1ms'", "finite number"),
        fault(STEP, STEP.replace("0.001", "nan"), "<max_step_size> is 'nan'", "finite number"),
        fault(RATE, RATE.replace("1000", "-1"), "<real_time_update_rate>", "number >= 0"),
        fault("_factor>1<", "_factor>0<", "<real_time_factor>", "number > 0"),
        fault(GRAVITY, "<gravity>-9.8</gravity>", "<gravity> is '-9.8'", "three finite numbers"),
        fault("<iters>50", "<iters>0", "<iters>", "whole number from 1 to"),
        fault("<iters>50", "<iters>2.5", "<iters>", "whole number from 1 to"),
        fault("<sor>1.3", "<sor>0", "<sor>", "write a number > 0, <= 2"),
        fault("<sor>1.3", "<sor>2.5", "<sor>", "write a number > 0, <= 2"),
        fault("<erp>0.2", "<erp>1.5", "<erp>", "write a number >= 0, <= 1"),
        fault("<cfm>0", "<cfm>-1", "<cfm>", "write a number >= 0"),
        fault("<type>quick", "<type>slow", "<type> is 'slow'", "write quick or world"),
        fault(WIND, WIND.replace("1 0 0", "1 0 fast"), "'1 0 fast'", "three finite numbers"),
        fault(GRAVITY, air("<temperature>0</temperature>"), "<temperature>", "a number > 0"),
        fault(GRAVITY, air("<pressure>-1</pressure>"), "<pressure>", "write a number >= 0"),
        fault(GRAVITY, air("<temperature_gradient>x</temperature_gradient>"), "finite number"),
    ],
    ids=str,
)
def test_a_value_that_is_none(broken):
    assert_refused("toy.world", broken)


@pytest.mark.parametrize(
    "broken",
    [
        *(
            fault(
                GRAVITY,
                f"<{name}/>",
                f"<{name}> in <world> is not supported",
                "takes atmosphere, gravity",
            )
            for name in ("state", "population", "joint")
        ),
        fault(GRAVITY, "<plugin/>", '<plugin> needs the attribute name="..."'),
        fault("<sor>1.3</sor>", "<use_dynamic_moi_rescaling>1</use_dynamic_moi_rescaling>", "0"),
        fault(GRAVITY, "<gravty>0 0 1</gravty>", "<gravty> in <world>", "did you mean 'gravity'?"),
        fault(GRAVITY, '<atmosphere type="thick"/>', "atmosphere type 'thick'", "write adiabatic"),
        fault(GRAVITY, air("<density>1</density>"), "<density> in <atmosphere>", "pressure"),
        fault(PHYSICS, '<physics type="bullet">', "physics type 'bullet'", "write ode"),
        fault(STEP, "<max_contacts>20</max_contacts>", "<max_contacts> in <physics>", "takes"),
        fault("<sor>1.3</sor>", "<friction_model/>", "<friction_model> in <solver>", "takes"),
        fault(WIND, "<angular_velocity/>", "<angular_velocity> in <wind>", "'linear_velocity'?"),
    ],
    ids=str,
)
def test_an_element_that_is_not_honoured(broken):
    assert_refused("toy.world", broken)


@pytest.mark.parametrize(
    "broken",
    [
        fault(PHYSICS, '<physics typ="ode">', "typ of <physics>", "did you mean 'type'?"),
        fault("<erp>", '<erp unit="1">', "unit of <erp>", "remove it"),
        fault("<wind>", '<wind mode="gust">', "mode of <wind>", "remove it"),
        fault(GRAVITY, "<gravity>0 0<!-- z --> -9.8</gravity>", "<gravity> is in pieces"),
    ],
    ids=str,
)
def test_what_would_be_passed_over(broken):
    assert_refused("toy.world", broken)


@pytest.mark.parametrize(
    "broken",
    [
        fault(GRAVITY, f"{GRAVITY}\n{GRAVITY}<!---->", "second <gravity>", "keep", at="<!---->"),
        fault(RATE, f"{RATE}<updateRate>9</updateRate>", "<updateRate> beside", "keep one"),
        fault(STEP, f"{STEP}<gravity>0 0 0</gravity>", "<gravity> beside", "toy.world:3", "keep"),
        fault(END, f"{END}<physics/>", "a second <physics>", "keep one of them"),
        fault(END, f"{END}<physics:ode/>", "<physics:ode> beside <physics>", "keep one of them"),
        fault("</world>", "</world><world/>", "a second <world>", "keep one of them"),
    ],
    ids=str,
)
def test_what_is_said_twice(broken):
    assert_refused("toy.world", broken)


PLANE = (
    "<model><static>true</static><link><collision><geometry><plane><normal>0 0 1</normal></plane>"
    "</geometry></collision></link></model>"
)


@pytest.mark.parametrize(
    "broken",
    [
        fault(WIND, "", "<wind> needs a <linear_velocity>; add one", at="<wind>"),
        fault(END, f"{END}<include/>", "<include> needs a <uri>; add one"),
        fault(
            END,
            f"{END}<include><uri>model://cessna</uri></include>",
            "'model://cessna' is not supported",
            "may include model://ground_plane and model://sun",
        ),
        fault(
            END,
            f"{END}<include><uri>model://sun</uri><pose/></include>",
            "<pose> in <include>",
            "takes uri",
        ),
        fault(END, END + PLANE.replace("0 0 1", "0 1 1"), "a level plane", "write 0 0 1"),
        fault(END, END + PLANE.replace("true", "false"), "a static model", "write true"),
        fault(END, END + PLANE.replace("<static>true</static>", ""), "<model> needs a <static>"),
        fault(END, END + PLANE.replace("plane", "sphere"), "<sphere> in <geometry>", "plane"),
        fault(END, END + PLANE.replace("<link>", "<pose/><link>"), "<pose> in <model>", "takes"),
        fault(END, f"{END}<model><static>true</static></model>", "<model> needs a <link>"),
    ],
    ids=str,
)
def test_a_model_that_is_no_ground_plane(broken):
    assert_refused("toy.world", broken)


@pytest.mark.parametrize(
    "broken",
    [
        fault("</physics>", "</physic>", "malformed XML", "mismatched tag"),
        fault('<sdf version="1.6">', "<!DOCTYPE sdf><sdf>", "DOCTYPE", "remove"),
        fault('<world name="toy">', '<world name="toy">text', "stray text 'text'", "remove it"),
    ],
    ids=str,
)
def test_xml_that_is_malformed_or_dangerous(broken):
    assert_refused("toy.world", broken)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("<gazebo/>", "toy.world:1: expected <sdf> as the outermost element, not <gazebo>"),
        ("<sdf/>", "toy.world:1: <sdf> needs a <world>; add one"),
        ("", "toy.world:1: "),
    ],
)
def test_a_file_that_is_no_world(toy, text, says):
    from faults import refusal

    import quadcore as qc

    (toy / "toy.world").write_text(text)
    assert refusal(qc.Simulation, "toy.urdf", world="toy.world").startswith(says)
