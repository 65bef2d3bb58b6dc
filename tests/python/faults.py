"""A good model and a good world, ways to break them, and what a refusal must look like."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple, Tuple

import pytest

import quadcore as qc

MODEL = """\
<robot name="toy">
  <link name="frame">
    <inertial>
      <mass value="1"/>
      <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.04"/>
    </inertial>
    <collision>
      <geometry><cylinder radius="0.1" length="0.02"/></geometry>
    </collision>
  </link>
  <link name="mount"/>
  <joint name="weld" type="fixed">
    <parent link="frame"/>
    <child link="mount"/>
  </joint>
  <link name="propeller">
    <inertial>
      <mass value="0.01"/>
      <inertia ixx="1e-5" ixy="0" ixz="0" iyy="1e-5" iyz="0" izz="2e-5"/>
    </inertial>
  </link>
  <joint name="rotor" type="continuous">
    <parent link="mount"/>
    <child link="propeller"/>
    <origin xyz="0 0 0.1"/>
    <axis xyz="0 0 1"/>
    <dynamics damping="1e-6"/>
  </joint>
  <gazebo>
    <plugin name="air" filename="libaerodynamic_plugin.so">
      <rotorThrustCoeff>1e-5</rotorThrustCoeff>
      <rotorTorqueCoeff>2e-7</rotorTorqueCoeff><inducedDragCoeff>0</inducedDragCoeff>
      <sim_slow>10</sim_slow>
    </plugin>
    <plugin name="motor" filename="libmotorpid_plugin.so">
      <kp>5e-4</kp>
      <sim_slow>10.0</sim_slow>
    </plugin>
    <plugin name="odometry" filename="libodometry_plugin.so">
      <rate>100</rate>
    </plugin>
  </gazebo>
  <link name='bearing'>
    <inertial>
      <mass value='2e-6'/>
      <inertia ixx='0' ixy='0' ixz='0' iyy='0' iyz='0' izz='0'/>
    </inertial>
  </link>
  <joint name='pressed' type='fixed'>
    <parent link='mount'/>
    <child link='bearing'/>
  </joint>
</robot>
"""

WORLD = """\
<sdf version="1.6">
  <world name="toy">
    <gravity>0 0 -9.8</gravity>
    <physics type="ode">
      <max_step_size>0.001</max_step_size>
      <real_time_factor>1</real_time_factor>
      <real_time_update_rate>1000</real_time_update_rate>
      <ode>
        <solver>
          <type>quick</type>
          <iters>50</iters>
          <sor>1.3</sor>
        </solver>
        <constraints>
          <cfm>0</cfm>
          <erp>0.2</erp>
        </constraints>
      </ode>
    </physics>
    <wind>
      <linear_velocity>1 0 0</linear_velocity>
    </wind>
  </world>
</sdf>
"""


class Fault(NamedTuple):
    """One change to a good document, and what its refusal must say."""

    old: str
    new: str
    says: Tuple[str, ...]
    at: str  # stands in the line at fault

    def __str__(self) -> str:
        return f"{self.says[0]}: {self.new}"[:80]


def fault(old: str, new: str, *says: str, at: str = "") -> Fault:
    """The line at fault is the first that changed, or that of `at` in the broken document."""
    return Fault(old, new, says, at)


def assert_refused(name: str, broken: Fault) -> None:
    """Break the document of that name; expect one line that says where, what and what instead."""
    path = Path(name)
    good = path.read_text()
    assert good.count(broken.old) == 1
    text = good.replace(broken.old, broken.new)
    path.write_text(text)
    assert text.count(broken.at) == 1 or not broken.at
    start = text.index(broken.at) if broken.at else good.index(broken.old)
    place = f"{name}:{1 + text.count(chr(10), 0, start)}: "
    message = refusal(qc.Simulation, "toy.urdf", world="toy.world")
    assert message.startswith(place)
    for part in broken.says:
        assert part in message


def refusal(call, *arguments, **options) -> str:
    """Message of the InputError that a call raises, which must be one line."""
    with pytest.raises(qc.InputError) as refused:
        call(*arguments, **options)
    message = str(refused.value)
    assert message and "\n" not in message
    return message


# A module that there is not, and the warning of what is passed over.
PUSHER = '<plugin name="pusher" filename="libpusher.so"><force>1<n>2</n></force></plugin>'
UNFELT = "ignored, because it does not affect the motion: "


def at(name, part):
    """FILE:LINE of the first line of a written file that holds a part."""
    text = Path(name).read_text()
    return f"{name}:{1 + text.count(chr(10), 0, text.index(part))}"
