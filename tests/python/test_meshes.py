"""Meshes as obstacles: files of three formats, contact, and broken files."""

from __future__ import annotations

import itertools
import pickle
import struct

import numpy as np
import pytest

import quadcore as qc
from quadcore import _core

CORNERS = [tuple(c) for c in itertools.product((-0.5, 0.5), repeat=3)]
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
TRIANGLES = [t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))]


def text_of_stl():
    facets = [
        "facet normal 0 0 0\nouter loop\n"
        + "".join("vertex {} {} {}\n".format(*CORNERS[i]) for i in triangle)
        + "endloop\nendfacet\n"
        for triangle in TRIANGLES
    ]
    return ("solid cube\n" + "".join(facets) + "endsolid\n").encode()


def binary_stl():
    facets = [
        struct.pack("<12fH", 0, 0, 0, *itertools.chain(*(CORNERS[i] for i in t)), 0)
        for t in TRIANGLES
    ]
    return b"solid binary".ljust(80) + struct.pack("<I", len(facets)) + b"".join(facets)


def obj():
    lines = ["v {} {} {}".format(*corner) for corner in CORNERS]
    lines += ["f " + " ".join(f"{i + 1}//1" for i in quad) for quad in QUADS]
    return "\n".join(lines).encode()


def collada(unit=0.01, up="Y_UP", transform="<translate>0 0 0</translate>"):
    """Return the cube in centimetres, of which the up axis must not count."""
    positions = " ".join(str(x / unit) for corner in CORNERS for x in corner)
    corners = " ".join(str(i) for quad in QUADS for i in quad)
    return f"""<COLLADA version="1.4.1"><asset><unit meter="{unit}"/><up_axis>{up}</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a">{positions}</float_array></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="6"><input semantic="VERTEX" source="#v" offset="0"/>
<vcount>4 4 4 4 4 4</vcount><p>{corners}</p></polylist>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node name="cube">{transform}
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>""".encode()


FILES = {
    "text.stl": text_of_stl(),
    "binary.stl": binary_stl(),
    "cube.obj": obj(),
    "cube.dae": collada(),
}


@pytest.fixture
def models(tmp_path, monkeypatch):
    monkeypatch.setenv("GAZEBO_MODEL_PATH", str(tmp_path))
    folder = tmp_path / "thing"
    folder.mkdir()
    return folder


def write_world(folder, file, content, more="", pose="0 0 0.5 0 0 0", static=1):
    (folder / file).write_bytes(content)
    world = folder.parent / "case.world"
    world.write_text(
        '<sdf version="1.6"><world name="w"><include><uri>model://ground_plane</uri></include>'
        f'<model name="thing"><static>{static}</static><pose>{pose}</pose><link name="l">'
        '<visual name="v"><geometry><mesh><uri>model://not/there.dae</uri></mesh></geometry>'
        f'</visual><collision name="c"><geometry><mesh><uri>model://thing/{file}</uri>{more}</mesh>'
        "</geometry></collision></link></model></world></sdf>"
    )
    return world


def read(world):
    return qc.Simulation("quadrotor", engine="gazebo11", world=world).world


@pytest.mark.parametrize("file", FILES)
def test_all_formats_contain_the_same_triangles(file, models):
    world = read(write_world(models, file, FILES[file], "<scale>2 -1 0.5</scale>"))
    (mesh,) = world.obstacles
    assert mesh.kind == "mesh"
    expected = np.array(CORNERS)[TRIANGLES] * (2, -1, 0.5)
    np.testing.assert_array_equal(mesh.vertices[mesh.triangles], expected)
    assert mesh.size.tolist() == [2, 1, 0.5]
    assert mesh.distance_to((0, 0.9, 0.5)) == pytest.approx(0.4)
    assert mesh.distance_to((0, 0, 0.5)) == pytest.approx(0.25)  # the surface has no inside
    (models / file).unlink()
    (again,) = pickle.loads(pickle.dumps(world)).obstacles
    np.testing.assert_array_equal(again.vertices, mesh.vertices)


def test_nodes_of_a_scene_move_their_meshes(models):
    turned = "<translate>100 0 0</translate><rotate>0 0 1 90</rotate><scale>1 2 1</scale>"
    (mesh,) = read(write_world(models, "cube.dae", collada(transform=turned))).obstacles
    assert mesh.size == pytest.approx([2, 1, 1])
    assert mesh.distance_to((1, 0.9, 0.5)) == pytest.approx(0.4, abs=1e-6)


def test_a_submesh_is_chosen_by_its_name_and_centred(models):
    shifted = collada(transform="<translate>300 0 0</translate>")
    chosen = "<submesh><name>cube</name><center>true</center></submesh>"
    (mesh,) = read(write_world(models, "cube.dae", shifted, chosen)).obstacles
    assert mesh.distance_to((0.8, 0, 0.5)) == pytest.approx(0.3, abs=1e-6)
    other = chosen.replace("cube", "ball")
    with pytest.raises(qc.InputError, match="the submesh 'ball' does not exist"):
        read(write_world(models, "cube.dae", shifted, other))


@pytest.mark.parametrize("engine", ["gazebo11", "ode"])
def test_a_vehicle_lands_on_a_mesh_as_on_a_box(engine, models):
    world = write_world(models, "cube.obj", FILES["cube.obj"], "<scale>4 4 1</scale>")
    landed = []
    for text in (world.read_text(), replace_mesh(world.read_text())):
        world.write_text(text)
        simulation = qc.Simulation("quadrotor", engine=engine, world=world, spawn=(0, 0, 1.2))
        simulation.step(1200)
        landed.append(simulation.state.position)
    np.testing.assert_allclose(landed[0], landed[1], atol=2e-4)
    assert landed[0][2] == pytest.approx(1.0125, abs=5e-4)


def replace_mesh(text):
    begin, end = text.index("<collision"), text.index("</collision>")
    box = '<collision name="c"><geometry><box><size>4 4 1</size></box></geometry>'
    return text[:begin] + box + text[end:]


def test_the_clearance_of_a_mesh_is_that_of_its_box(models):
    world = write_world(models, "cube.obj", FILES["cube.obj"], pose="1.7 0 9.9 0 0 0.3")
    nearest = []
    for text in (world.read_text(), replace_mesh(world.read_text()).replace("4 4 1", "1 1 1")):
        world.write_text(text)
        simulation = qc.Simulation("quadrotor", engine="gazebo11", world=world)
        poses = np.array([[0.0, 0, 10, 0, 0, 0, 1], [0.5, 0.2, 10.3, 0, 0, 0.1, 0.99]])
        nearest.append(_core.find_clearance(simulation.model, simulation.world, poses)[0])
    np.testing.assert_allclose(nearest[0], nearest[1], atol=1e-6)


@pytest.mark.parametrize(
    "file, content, complaint",
    [
        ("a.stl", b"", "the file ends in its header"),
        ("a.stl", binary_stl()[:-1], "the file ends before its last triangle"),
        ("a.stl", text_of_stl().replace(b"vertex -0.5", b"vertex nan", 1), "'nan' is no coord"),
        ("a.stl", b"solid\nfacet\nvertex 0 0 0\n", "the file ends within a triangle"),
        ("a.stl", b"solid\nfacet\n", "the file has no triangles"),
        ("a.obj", b"v 0 0 0\nf 1 2 3\n", "a triangle names a missing vertex"),
        ("a.obj", b"v 0 0 0\nf 0 1 1\n", "'0' is no corner of a face"),
        ("a.obj", b"v 0 0\n", "'' is no coordinate"),
        ("a.dae", b"<COLLADA", "malformed XML"),
        ("a.dae", b"<a/>", "the outermost element is not <COLLADA>"),
        ("a.dae", b"<COLLADA/>", "the file has no scene"),
        ("a.dae", collada().replace(b"#g", b"#h"), "<geometry> '#h' does not exist"),
        ("a.dae", collada().replace(b"<p>0", b"<p>99"), "a triangle names a missing vertex"),
        ("a.dae", collada(unit=1).replace(b'meter="1"', b'meter="0"'), "the unit is not positive"),
        (
            "a.dae",
            collada(transform='<instance_node url="#n"/>').replace(b"<node ", b'<node id="n" '),
            "a node contains itself",
        ),
        ("a.dae", collada(transform="<matrix>1 2</matrix>"), "<matrix> has too few numbers"),
        ("a.txt", b"", "a mesh of this format is not supported. Use .stl, .dae or .obj"),
    ],
)
def test_a_broken_file_is_one_line(file, content, complaint, models):
    with pytest.raises(qc.InputError) as refusal:
        read(write_world(models, file, content))
    message = str(refusal.value)
    assert complaint in message and f"thing/{file}: " in message
    assert "\n" not in message


def test_a_mesh_that_is_not_found_is_missing_in_the_world(models):
    world = write_world(models, "cube.obj", FILES["cube.obj"], "<scale>0 1 1</scale>")
    with pytest.raises(qc.InputError, match=r"case\.world:1: <scale> is 0. Correct it"):
        read(world)
    world = write_world(models, "cube.obj", FILES["cube.obj"])
    (models / "cube.obj").unlink()
    without = qc.read_world(world)
    assert without.obstacles == []
    (missing,) = without.ignored_elements.unsimulated
    assert missing.startswith("the missing mesh ") and missing.endswith("cube.obj of thing")
    with pytest.warns(qc.QuadcoreWarning, match="thing"):
        qc.Simulation("quadrotor", engine="gazebo11", world=world, ignore=["thing"])


def test_a_broken_mesh_of_an_ignored_model_is_not_read(models):
    world = write_world(models, "cube.obj", b"v 0 0 zero\n")
    with pytest.raises(qc.InputError, match=r"cube\.obj.*use --ignore thing\.$"):
        read(world)
    assert qc.read_world(world, ignore=["thing"]).ignored_models == ["thing"]


def test_a_polyline_is_extruded(models):
    """An L, given clockwise, of 3 square metres; a second polyline would be a hole."""
    points = [(0, 0), (0, 2), (1, 2), (1, 1), (2, 1), (2, 0)]
    polyline = "<polyline>{}<height>0.5</height></polyline>".format(
        "".join(f"<point>{x} {y}</point>" for x, y in points)
    )
    world = write_world(models, "cube.obj", FILES["cube.obj"])
    text = world.read_text()
    begin = text.index("<collision")
    begin += text[begin:].index("<mesh>")
    end = begin + text[begin:].index("</mesh>") + len("</mesh>")
    world.write_text(text[:begin] + polyline + text[end:])
    (prism,) = read(world).obstacles
    corners = prism.vertices[prism.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    # Divergence theorem: the volume is a third of the flux of x.
    volume = np.sum(normals * corners.mean(axis=1)) / 3
    assert volume == pytest.approx(3 * 0.5)
    assert normals.sum(axis=0) == pytest.approx([0, 0, 0])
    crossing = polyline.replace("<point>1 1</point>", "<point>-1 3</point>")
    for wrong, complaint in [
        (crossing, "crosses itself or has no area"),
        (polyline * 2, "a second <polyline>"),
        (polyline.replace("2 1", "nan 1"), "<point> is 'nan 1'"),
    ]:
        world.write_text(text[:begin] + wrong + text[end:])
        with pytest.raises(qc.InputError, match=complaint):
            read(world)
