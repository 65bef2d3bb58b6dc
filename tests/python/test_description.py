"""Reading models and worlds: what is expanded, where it came from, what is refused."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

import quadcore as qc
from quadcore import _core
from quadcore.model import resources
from quadcore.model.description import load_description, load_world
from quadcore.model.xacro_expansion import expand

XMLNS = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'


@pytest.fixture
def write(tmp_path, monkeypatch):
    """Write a file into the working directory and return its name."""
    monkeypatch.chdir(tmp_path)

    def write(name, *lines):
        Path(name).write_text("\n".join(lines))
        return name

    return write


@pytest.fixture
def robot(write):
    """Write a xacro file whose robot holds the given lines, the first of them on line 2."""
    return lambda *lines, name="robot.xacro": write(name, f"<robot {XMLNS}>", *lines, "</robot>")


def places(lines):
    """FILE:LINE of each start tag of an expanded document."""
    return {text.split(">")[0] + ">": str(place) for text, place in lines if text[1] != "/"}


def refusal(file, arguments=None):
    with pytest.raises(qc.QuadcoreError) as refused:
        load_description(file, arguments or {})
    assert "\n" not in str(refused.value)
    return str(refused.value)


def test_every_element_knows_its_file_and_line_through_macros_includes_and_blocks(robot):
    robot(
        '<xacro:macro name="arm" params="n *tip">',
        '  <link name="arm${n}">',
        "    <mass",
        '      value="${n * 2}"/>',
        '    <xacro:insert_block name="tip"/>',
        "  </link>",
        "</xacro:macro>",
        name="arm.xacro",
    )
    file = robot(
        '<xacro:include filename="arm.xacro"/>',
        "<xacro:arm",
        '  n="1"><inertia a="1"/></xacro:arm>',
        "<plain/>",
        '<xacro:if value="1"><inside/></xacro:if>',
    )
    assert places(expand(file, {})) == {
        "<robot>": "robot.xacro:1",
        '<link name="arm1">': "arm.xacro:3",
        '<mass value="2"/>': "arm.xacro:4",
        '<inertia a="1"/>': "robot.xacro:4",
        "<plain/>": "robot.xacro:5",
        "<inside/>": "robot.xacro:6",
    }


def test_an_error_of_the_model_names_the_line_of_the_xacro(write):
    file = write(
        "robot.xacro",
        f'<robot name="a" {XMLNS}>',
        "<!-- xacro drops",
        "comments -->",
        '<link name="b"><mass value="${1 + 1}"/></link>',
        "</robot>",
    )
    with pytest.raises(qc.InputError, match=r"^robot\.xacro:4: "):
        _core.read_model(load_description(file, {}))


def test_text_survives_expansion_with_its_special_characters(robot):
    file = robot("<a b='&lt;&quot;&amp;'>x &lt; y &amp; z<![CDATA[<c>]]></a>")
    text = "\n".join(line for line, _ in expand(file, {}))
    assert "x &lt; y &amp; z&lt;c&gt;</a>" in text
    assert "b='&lt;\"&amp;'" in text


def test_arguments_reach_the_xacro(robot):
    file = robot('<xacro:arg name="k" default="1"/>', '<a v="$(arg k)"/>')
    assert '<a v="1"/>' in places(expand(file, {}))
    assert '<a v="2.5"/>' in places(expand(file, {"k": "2.5"}))


def test_an_argument_without_declaration_can_be_given(robot):
    assert '<a v="7"/>' in places(expand(robot('<a v="$(arg needed)"/>'), {"needed": "7"}))


def test_find_resolves_this_package_and_those_on_the_ros_path(robot, tmp_path, monkeypatch):
    package = tmp_path / "packages" / "other_package"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>other_package</name></package>")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(package.parent))
    file = robot('<a v="$(find quadcore)/urdf"/>', '<b v="$(find other_package)"/>')
    found = places(expand(file, {}))
    assert f'<a v="{resources.find_root()}/urdf"/>' in found
    assert f'<b v="{package}"/>' in found


def test_an_optional_include_may_be_missing(robot):
    file = robot('<xacro:include filename="nowhere.xacro" optional="true"/>', "<a/>")
    assert "<a/>" in places(expand(file, {}))


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ('<a v="${nope}"/>', "'nope' is not defined"),
        ('<a v="${1/0}"/>', "division by zero"),
        ('<a v="$(arg nope)"/>', "undefined xacro argument 'nope'"),
        ('<a v="$(find nope)"/>', "package 'nope' not found"),
        ('<a v="$(nope nope)"/>', "Unknown substitution command"),
        ("<a>${nope}</a>", "'nope' is not defined"),
        ("<xacro:nope/>", "unknown macro"),
        ("<xacro:macro/>", "missing attribute 'name'"),
        ('<xacro:if value="maybe"/>', "not a boolean"),
        ('<xacro:include filename="nope.xacro"/>', "nope.xacro: cannot be read: No such file"),
        ('<xacro:include filename="robot.xacro"/>', "contains itself"),
        ('<a v="1" v="2"/>', "malformed XML: duplicate attribute"),
        ("<a></b>", "malformed XML: mismatched tag"),
        ("<unknown:a/>", "malformed XML: unbound prefix"),
    ],
)
def test_a_fault_in_a_xacro_names_file_line_and_reason(robot, line, reason):
    message = refusal(robot("", "<ok/>", line))
    assert message.startswith("robot.xacro:4: ")
    assert reason in message


def test_a_fault_inside_a_macro_names_the_line_in_the_macro(robot):
    macro = ('<xacro:macro name="m" params="k">', '<a v="${k + 1}"/>', "</xacro:macro>")
    assert refusal(robot(*macro, '<xacro:m k="text"/>')).startswith("robot.xacro:3: ")
    assert refusal(robot(*macro, "<xacro:m/>")).startswith("robot.xacro:5: ")


@pytest.mark.parametrize("name", ["robot.urdf", "robot.xacro"])
def test_a_doctype_is_refused(write, name):
    file = write(name, "<!-- -->", '<!DOCTYPE robot [<!ENTITY a "b">]>', "<robot>&a;</robot>")
    assert refusal(file).startswith(f"{name}:2: DOCTYPE")


def test_a_doctype_in_an_included_file_is_refused(write, robot):
    write("part.xacro", "<!DOCTYPE robot>", "<robot/>")
    assert refusal(robot('<xacro:include filename="part.xacro"/>')).startswith("part.xacro:1: ")


def test_an_unknown_xacro_argument_is_refused_with_the_known_ones(robot):
    file = robot('<xacro:arg name="sim_slow" default="1"/>', '<xacro:arg name="kp" default="1"/>')
    message = refusal(file, {"sim_slwo": "2"})
    assert "has no xacro argument 'sim_slwo'. Did you mean 'sim_slow'? Use one of " in message
    assert "has no xacro argument 'kp'. Leave it out." in refusal(robot("<a/>"), {"kp": "2"})


def test_a_plain_urdf_is_read_as_it_is_and_takes_no_xacro_arguments(write):
    file = write("robot.urdf", '<robot name="a">', "${x}</robot>")
    document = load_description(file, {})
    assert document.text == '<robot name="a">\n${x}</robot>'
    assert document.lines == []
    assert "takes no xacro arguments" in refusal(file, {"k": "1"})


def test_malformed_xml_names_its_line(write):
    assert refusal(write("a.urdf", "<robot>", "<link>", "</robot>")).startswith("a.urdf:3: ")
    assert refusal(write("empty.urdf")).startswith("empty.urdf:1: malformed XML: no element")


def test_files_that_are_no_text_are_refused(tmp_path):
    for content, reason in (
        (b"\x7fELF\0\0", "binary file"),
        (b"<a>\n\xff</a>", ":2: the text is not UTF-8"),
    ):
        file = tmp_path / "robot.urdf"
        file.write_bytes(content)
        assert reason in refusal(str(file))


def test_a_missing_model_names_the_shipped_ones(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert refusal("nope.urdf").startswith("nope.urdf: neither a file")
    assert "quadrotor" in refusal("nope")
    assert "is a folder" in refusal(str(tmp_path))


def test_the_shipped_model_and_worlds_load_by_name():
    assert _core.read_model(load_description("quadrotor", {})).name == "quadrotor"
    for name in (None, "empty", "empty.world", "default"):
        assert "<world" in load_world(name).text


def test_a_world_may_use_namespace_prefixes_without_declaring_them(write):
    file = write("a.world", "<sdf><world><physics:ode/></world></sdf>")
    assert "physics:ode" in load_world(file).text


def test_what_xacro_warns_of_is_passed_on_with_its_place_and_not_printed(robot, capfd):
    file = robot('<link name="a"/>', '<xacro:include filename="nothing_*.xacro"/>')
    with pytest.warns(qc.QuadcoreWarning) as shown:
        expand(file, {})
    (warning,) = shown
    assert str(warning.message).startswith("robot.xacro:3: ")
    assert "nothing_*.xacro" in str(warning.message)
    assert capfd.readouterr() == ("", "")


def test_a_pipe_is_not_included(robot):
    os.mkfifo("pipe.xacro")
    assert refusal(robot('<xacro:include filename="pipe.xacro"/>')).startswith("robot.xacro:2: ")
