"""What the player draws of a model: the shapes, colours and meshes of its <visual> elements."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import quadcore as qc
from quadcore.model import resources
from quadcore.model.visuals import read_vehicle
from quadcore.support.rotation import compose_roll_pitch_yaw

INERTIAL = """<inertial><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>"""
MODEL = """<robot name="drawn">
<material name="green"><color rgba="0 0.5 0 1"/></material>
<link name="frame">{inertial}
<visual>
  <origin xyz="1 2 3" rpy="0.1 0.2 0.3"/>
  <geometry>{shape}</geometry><material name="green"/>
</visual></link>
<link name="mast"><visual>
  <origin xyz="0 0 1"/><geometry><sphere radius="0.2"/></geometry>
</visual></link>
<joint name="stays" type="fixed"><parent link="frame"/><child link="mast"/>
<origin xyz="0 1 0" rpy="1.5707963267948966 0 0"/></joint>
<link name="blade">{inertial}</link>
<joint name="turns" type="continuous"><parent link="frame"/><child link="blade"/>
<origin xyz="0.5 0 0"/><axis xyz="0 0 1"/></joint>
</robot>
"""


def drawn(tmp_path, shape='<box size="1 2 3"/>'):
    file = tmp_path / "drawn.urdf"
    file.write_text(MODEL.format(inertial=INERTIAL, shape=shape))
    return read_vehicle(qc.read_model(file))


def test_shapes_have_size_pose_and_colour_in_their_body(tmp_path):
    frame, blade = drawn(tmp_path).bodies
    box, ball = frame.shapes
    assert (box.kind, box.size, box.colour) == ("box", (1, 2, 3), (0, 0.5, 0, 1))
    turned = Rotation.from_euler("xyz", [0.1, 0.2, 0.3]).as_matrix()
    assert np.allclose(box.pose[:3], np.column_stack([turned, [1, 2, 3]]))
    # The mast stands on a joint that turns its z to -y of the frame.
    assert (ball.kind, ball.size) == ("sphere", (0.2,))
    assert np.allclose(ball.pose[:3, 3], [0, 0, 0])
    assert np.allclose(blade.pose[:3, 3], [0.5, 0, 0]) and np.array_equal(blade.axis, [0, 0, 1])


def test_a_body_without_visuals_is_its_equivalent_inertia_box(tmp_path):
    (box,) = drawn(tmp_path).bodies[1].shapes
    # A cube of 1 kg with moments of 1 kg m^2: m a^2 / 6.
    assert box.kind == "box" and box.size == pytest.approx([np.sqrt(6)] * 3)


def test_angles_of_an_origin_are_those_of_scipy():
    for angles in np.random.default_rng(1).uniform(-3, 3, (20, 3)):
        expected = Rotation.from_euler("xyz", angles).as_matrix()
        assert np.allclose(compose_roll_pitch_yaw(angles), expected)


@pytest.mark.parametrize("name", sorted(resources.list_shipped("urdf")))
def test_shipped_vehicles_have_arms_that_reach_their_rotors(name):
    model = qc.read_model(name)
    frame, *rotors = read_vehicle(model).bodies
    assert len(rotors) == len(model.joints)
    assert all(rotor.shapes[0].kind == "cylinder" for rotor in rotors)
    ends = []
    for shape in frame.shapes:
        if shape.kind == "box":
            ends += [shape.pose[:3, 3] + side * shape.pose[:3, 0] * shape.size[0] / 2
                     for side in (-1, 1)]  # fmt: skip
        elif shape.kind == "cylinder":
            ends += [shape.pose[:3, 3] + side * shape.pose[:3, 2] * shape.size[1] / 2
                     for side in (-1, 1)]  # fmt: skip
    for place in model.joint_places:
        apart = np.linalg.norm(np.array(ends)[:, :2] - place[:2], axis=1)
        assert apart.min() < 1e-6


def write_meshes(folder):
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, 3)], float)
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    with open(folder / "a.stl", "wb") as stream:
        stream.write(bytes(80) + struct.pack("<I", len(faces)))
        for face in faces:
            stream.write(struct.pack("<12f", 0, 0, 0, *corners[list(face)].ravel()) + b"\0\0")
    with open(folder / "a.obj", "w") as text:
        text.writelines("v {} {} {}\n".format(*corner) for corner in corners)
        text.writelines("f {} {} {}\n".format(*(i + 1 for i in face)) for face in faces)
    collada = pytest.importorskip("collada")
    mesh = collada.Collada()
    points = collada.source.FloatSource("points", corners.ravel(), ("X", "Y", "Z"))
    geometry = collada.geometry.Geometry(mesh, "g", "g", [points])
    inputs = collada.source.InputList()
    inputs.addInput(0, "VERTEX", "#points")
    geometry.primitives.append(geometry.createTriangleSet(np.array(faces).ravel(), inputs, "m"))
    mesh.geometries.append(geometry)
    node = collada.scene.Node("n", children=[collada.scene.GeometryNode(geometry, [])])
    mesh.scenes.append(collada.scene.Scene("s", [node]))
    mesh.scene = mesh.scenes[0]
    mesh.write(str(folder / "a.dae"))


@pytest.mark.parametrize("suffix", ["stl", "obj", "dae"])
def test_meshes_keep_their_volume(suffix, tmp_path):
    pytest.importorskip("trimesh")
    write_meshes(tmp_path)
    found = drawn(tmp_path, f'<mesh filename="a.{suffix}" scale="2 1 1"/>').bodies[0].shapes[0]
    assert found.kind == "mesh" and found.size == (2, 1, 1)
    triangles = np.asarray(found.vertices)[np.asarray(found.faces)]
    volume = np.linalg.det(triangles).sum() / 6  # the divergence theorem
    assert volume == pytest.approx(1 * 2 * 3 / 6)


@pytest.mark.parametrize(
    ("shape", "message"),
    [
        ('<box size="1 2"/>', 'size="1 2" does not contain 3 finite numbers'),
        ('<cone radius="1"/>', "'cone' is no shape"),
        ('<mesh filename="no.stl"/>', "no.stl: does not exist. Correct the file name."),
        ('<mesh filename="a.ply"/>', "a.ply: is no mesh of a known kind"),
        ('<mesh filename="web://a.stl"/>', "has an unknown scheme. Use package:// or file://."),
        ('<mesh filename="package://no_such/a.stl"/>', "package 'no_such' is not found"),
        (
            '<mesh filename="text.stl"/>',
            "text.stl: has 0 triangles; 1 to 200000 are drawn.",
        ),
    ],
)
def test_what_cannot_be_drawn_is_left_out_with_a_warning(shape, message, tmp_path):
    pytest.importorskip("trimesh")
    (tmp_path / "text.stl").write_text("solid\nnothing\n")
    with pytest.warns(qc.QuadcoreWarning, match="<visual> not drawn") as warned:
        frame = drawn(tmp_path, shape).bodies[0]
    (text,) = (str(warning.message) for warning in warned)
    assert text.startswith(f"{tmp_path}/drawn.urdf:5: ") and message in text
    assert [shape.kind for shape in frame.shapes] == ["sphere"]
