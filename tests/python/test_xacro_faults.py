"""Errors of xacro name the argument that causes them."""

from __future__ import annotations

from pathlib import Path

import pytest
from faults import refusal

import quadcore as qc
from quadcore.model import resources

SHIPPED = Path(resources.list_shipped("urdf")["quadrotor"]).name


def read_error(**arguments):
    message = refusal(qc.Simulation, xacro_args=arguments)
    place, _, what = message.partition(": ")
    assert Path(place.rpartition(":")[0]).name == SHIPPED and int(place.rpartition(":")[2]) > 0
    return what


@pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")
def test_the_argument_that_cannot_be_used_is_named_with_what_can():
    every = "all, none, induced, translational, profile, parasitic"
    says = (
        "xacro argument 'drag' is 'foo' (default 'all'): key 'foo' does not exist. "
        f"Use one of {every}."
    )
    assert read_error(drag="foo").startswith(says)
    assert read_error(sim_slow=1, drag="foo", nothing=3).startswith(says)
    assert "(default 'pid'): key 'foo' does not exist. Use one of pid, first_order." in read_error(
        motor="foo"
    )
    long = read_error(arm_length="long")
    assert long.startswith(
        "xacro argument 'arm_length' is 'long' (default '0.1'): unsupported operand"
    )


def test_of_two_arguments_at_fault_neither_is_blamed_alone():
    what = read_error(arm_length="long", drag="foo")
    assert "xacro argument" not in what and "evaluating expression" in what


MODEL = """<robot name="x" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:property name="table" value="${dict(a=1)}"/>
<link name="${table['b']}"/>
</robot>
"""


def test_a_key_that_a_file_itself_lacks_is_named_with_the_expression(tmp_path):
    path = tmp_path / "x.urdf.xacro"
    path.write_text(MODEL)
    assert (
        refusal(qc.Simulation, path) == f"{path}:3: key 'b' does not exist. Correct 'table['b']'."
    )
    path.write_text(MODEL.replace("table['b']", "dict(c=1, d=2)['b']"))
    assert refusal(qc.Simulation, path) == f"{path}:3: key 'b' does not exist. Use one of c, d."


def test_a_file_for_xacro_that_is_called_a_urdf_is_to_be_renamed(tmp_path):
    path = tmp_path / "x.urdf"
    path.write_text(MODEL)
    message = refusal(qc.Simulation, path)
    assert message.startswith(f"{path}:2: <xacro:property> is an xacro element, which is")
    assert message.endswith("expanded only in files named *.xacro. Rename the file.")
    link = '<robot name="x"><link name="a"><xacro:box/></link></robot>'
    path.write_text(link)
    assert "Rename the file." in refusal(qc.Simulation, path)
