"""Fireflies that carry more modules of RotorS', and a mast to carry them."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

import quadcore as qc

HOVER = 543.322
TUMBLE = np.array([[0, HOVER + 8, HOVER, HOVER - 3, HOVER, HOVER + 2, HOVER - 6]])


def plugin(name, module, **tags):
    inner = "".join(f"<{tag}>{value}</{tag}>" for tag, value in tags.items())
    opening = f'<gazebo><plugin name="{name}" filename="librotors_gazebo_{module}.so">'
    return f"{opening}{inner}</plugin></gazebo>"


MAST = (
    '<link name="mast"><inertial><origin xyz="0.02 0 0.1"/><mass value="0.01"/>'
    '<inertia ixx="1e-5" ixy="0" ixz="0" iyy="1e-5" iyz="0" izz="1e-5"/></inertial></link>'
    '<joint name="stay" type="fixed"><parent link="firefly/base_link"/><child link="mast"/>'
    '<origin xyz="0.03 -0.04 0.05" rpy="0.3 0.2 0.1"/></joint>'
)
X_FS = np.array([0.03, -0.04, 0.05])
R_FS = Rotation.from_euler("xyz", [0.3, 0.2, 0.1])


def firefly_with(folder, *parts, engine="gazebo11", spawn=(0, 0, 10), **options):
    """Make a firefly with a mast and further parts of a URDF."""
    text = qc.read_model("firefly").document.text
    path = folder / "fitted.urdf"
    path.write_text(text.replace("</robot>", MAST + "".join(parts) + "</robot>"))
    return qc.Simulation(path, engine=engine, spawn=spawn, **options)
