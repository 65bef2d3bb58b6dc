"""XML made to exhaust or fool its reader is refused: in one line, soon, by every reader."""

from __future__ import annotations

import contextlib
import time
from pathlib import Path

import pytest
from faults import MODEL, WORLD, refusal

import quadcore as qc
from quadcore import _core

pytestmark = pytest.mark.usefixtures("toy")

XACRO = '<robot name="toy" xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
LAUGHS = "".join(
    f'<!ENTITY laugh{i} "{f"&laugh{i - 1};" * 10 if i else "ha"}">\n' for i in range(10)
)
ANY = '<{root} name="toy">'  # {root} becomes robot or sdf


# Nothing here takes two seconds of the slowest processor; what grows with the square of these
# inputs, or without bound, would take minutes.
SOON = 20.0  # s of the processor's time


@contextlib.contextmanager
def soon():
    begin = time.process_time()
    yield
    assert time.process_time() - begin < SOON


def read_refusal(call, *arguments, **options) -> str:
    """Message of the InputError, which must come soon."""
    with soon():
        message = refusal(call, *arguments, **options)
    assert len(message) <= 1000
    return message


def read_urdf(data):
    Path("hostile.xml").write_bytes(data)
    return read_refusal(qc.Simulation, "hostile.xml")


def read_xacro(data):
    Path("hostile.xml.xacro").write_bytes(data)
    return read_refusal(qc.Simulation, "hostile.xml.xacro").replace(".xml.xacro", ".xml")


def read_included(data):
    Path("hostile.xml").write_bytes(data)
    Path("outer.xacro").write_text(XACRO.format('\n<xacro:include filename="hostile.xml"/>'))
    message = read_refusal(qc.Simulation, "outer.xacro")
    return message.replace(str(Path("hostile.xml").resolve()), "hostile.xml")


def read_world(data):
    Path("hostile.xml").write_bytes(data)
    return read_refusal(qc.Simulation, "toy.urdf", world="hostile.xml")


def read_by_the_core(data):
    # Undecodable bytes cannot come this way.
    document = _core.Document("hostile.xml", data.decode())
    read = _core.read_world if b"<sdf" in data else _core.read_model
    return read_refusal(read, document)


ROUTES = {
    "urdf": (read_urdf, b"robot"),
    "xacro": (read_xacro, b"robot"),
    "included xacro": (read_included, b"robot"),
    "world": (read_world, b"sdf"),
    "model in C++": (read_by_the_core, b"robot"),
    "world in C++": (read_by_the_core, b"sdf"),
}


@pytest.fixture(params=ROUTES)
def read(request):
    """A reader of bytes in which {root} stands for the root's name; returns its refusal."""
    reader, root = ROUTES[request.param]
    return lambda text: reader(text.encode().replace(b"{root}", root))


@pytest.mark.parametrize(
    "declaration",
    [
        f"<!DOCTYPE {{root}} [\n{LAUGHS}]>\n<{{root}} name='&laugh9;'/>",
        '<!DOCTYPE {root} [<!ENTITY x SYSTEM "file:///etc/passwd">]>\n<{root} name="&x;"/>',
        '<!DOCTYPE {root} [<!ENTITY % x SYSTEM "file:///etc/passwd"> %x;]>\n<{root} name="x"/>',
        '<!DOCTYPE {root} SYSTEM "http://127.0.0.1:9/x.dtd">\n<{root} name="x"/>',
        "<!DOCTYPE {root}>\n<{root} name='x'/>",
    ],
    ids=["billion laughs", "external entity", "parameter entity", "external DTD", "bare"],
)
def test_a_doctype(read, declaration):
    message = read(declaration)
    assert message.startswith("hostile.xml:1: ")
    assert "DOCTYPE" in message and "Remove" in message


def test_nesting_a_hundred_thousand_levels_deep(read):
    message = read(ANY + "<a>\n" * 100_000 + "</a>" * 100_000 + "</{root}>")
    assert message.startswith("hostile.xml:64: elements are nested deeper than 64 levels")


def test_nesting_hidden_behind_marks_that_do_not_close(read):
    hidden = "<!-- </a> --><a b='/>' c=\"/a>\">" * 1000
    message = read(ANY + "\n" + hidden + "</a>" * 1000 + "</{root}>")
    assert message.startswith("hostile.xml:2: elements are nested deeper than 64 levels")


def test_depth_that_is_only_seeming(toy):
    text = MODEL.replace("<gazebo>", "<!-- " + "<a>" * 1000 + " -->\n" * 2 + "<gazebo>", 1)
    flat = MODEL.replace("<gazebo>", "<material/>" * 1000 + "<!-- <a> -->" * 100 + "<gazebo>", 1)
    deep = MODEL.replace(
        '<link name="mount"/>',
        '<link name="mount"><visual>' + "<a>" * 50 + "</a>" * 50 + "</visual></link>",
    )
    for good in (text.replace("<!-- <a>", "<!--<a>"), flat, deep):
        Path("good.urdf").write_text(good.replace(" -->\n -->\n", " -->\n"))
        qc.Simulation("good.urdf").step()


@pytest.mark.parametrize("route", ROUTES)
def test_a_document_of_many_megabytes(route):
    reader, root = ROUTES[route]
    limit = "10 MB" if root == b"sdf" else "1 MB"
    for text in (b'< name="' + b"x" * 20_000_000 + b'"/>', b"<>" + b" " * 20_000_000):
        message = reader(text.replace(b"<", b"<" + root, 1))
        assert message == f"hostile.xml: the file exceeds the limit of {limit}. Use a smaller file."


def test_a_number_of_half_a_megabyte(toy):
    for good, bad in (('value="1"', 'value="{}"'), ("0 0 0.1", "{}"), (">5e-4<", ">{}<")):
        for digits in ("1" * 500_000, "1 " * 250_000, "nan" * 100_000):
            broken = MODEL.replace(good, bad.format(digits))
            for name in ("toy.urdf", "toy.xacro"):
                Path(name).write_text(broken)
                assert read_refusal(qc.Simulation, name).startswith(f"{name}:")


def test_names_of_half_a_megabyte(toy):
    text = MODEL.replace('child link="propeller"', f'child link="{"x" * 300_000}"')
    text = text.replace(
        '<link name="mount"/>', f'<link name="mount"/>\n<link name="{"y" * 300_000}"/>'
    )
    Path("toy.urdf").write_text(text)
    assert "does not exist" in read_refusal(qc.Simulation, "toy.urdf")


def test_an_element_of_a_hundred_thousand_attributes(read):
    attributes = "".join(f' a{i}=""' for i in range(90_000))
    message = read(f'<{{root}} name="toy"{attributes}/>')
    assert message.startswith("hostile.xml:1: an element has more than 100 attributes")


@pytest.mark.parametrize("size", [5000, -5000], ids=["in order", "in reverse"])
def test_a_chain_of_thousands_of_links_is_read_or_refused_in_time(toy, size):
    def link(i, parent):
        joint = f'<joint name="j{i}" type="fixed"><parent link="{parent}"/><child link="l{i}"/>'
        return f'<link name="l{i}"/>{joint}</joint>\n'

    order = range(abs(size)) if size > 0 else reversed(range(abs(size)))
    chain = [link(i, f"l{i - 1}" if i else "frame") for i in order]
    document = _core.Document("long", MODEL.replace("</robot>", "".join(chain) + "</robot>"))
    with soon():
        assert len(_core.read_model(document).links) == 2
    chain[0 if size > 0 else -1] = link(0, f"l{abs(size) - 1}")
    Path("toy.urdf").write_text(MODEL.replace("</robot>", "".join(chain) + "</robot>"))
    assert "closes a loop of links" in read_refusal(qc.Simulation, "toy.urdf")


@pytest.mark.parametrize("character", ["\0", "\x01", "\x1b[2J", "\x0c"])
def test_a_control_character(read, character):
    for text in (f'{ANY[:-1]}\n value="a{character}b"/>', f"{ANY}\n</{{root}}>{character}"):
        message = read(text)
        assert message.startswith("hostile.xml")
        assert character not in message


@pytest.mark.parametrize(
    "data", [b"\xff\xfe", b"\xc0\xae", b"\xed\xa0\x80", b"\xf4\x90\x80\x80", b"\xe2\x82", b"\x80"]
)
@pytest.mark.parametrize("route", ["urdf", "xacro", "included xacro", "world"])
def test_bytes_that_are_no_utf_8(route, data):
    reader, root = ROUTES[route]
    message = reader(b"<" + root + b'\n name="' + data + b'"/>')
    assert message == "hostile.xml:2: the text is not UTF-8. Save the file as UTF-8."


def test_another_encoding_is_refused_whatever_it_declares():
    for route in ("urdf", "world"):
        reader, _ = ROUTES[route]
        text = MODEL if route == "urdf" else WORLD
        for encoding in ("utf-16", "utf-32"):
            declared = f'<?xml version="1.0" encoding="{encoding}"?>\n{text}'
            message = reader(declared.encode(encoding))
            assert message.startswith("hostile.xml") and "text" in message


def test_an_escaped_line_break_in_a_name_does_not_break_the_message(toy):
    text = MODEL.replace('name="weld" type="fixed"', 'name="we&#10;ld" type="welded&#13;&#10;"')
    Path("toy.urdf").write_text(text)
    assert "joint 'we ld' is of type 'welded'" in read_refusal(qc.Simulation, "toy.urdf")


MULTIPLY = "".join(
    f'<xacro:macro name="m{i}">{f"<xacro:m{i - 1}/>" * 10 if i else "<link/>"}</xacro:macro>'
    for i in range(10)
)
DOUBLE = "".join(
    f'<xacro:property name="p{i}" value="{f"${{p{i - 1}}}" * 10 if i else "ha"}"/>\n'
    for i in range(10)
)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (f"{MULTIPLY}\n<xacro:m9/>", "expands to more than 20000 elements"),
        (f'{DOUBLE}<link name="${{p9}}"/>', "expands to a text of more than 1 MB"),
        ('\n<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>', "contains itself"),
        ('\n<xacro:include filename="hostile.xacro"/>', "contains itself"),
        ("<link name=\"${'x' * 2000000}\"/>", "expands to a text of more than 1 MB"),
    ],
    ids=["macros", "properties", "recursion", "inclusion", "expression"],
)
def test_a_xacro_that_expands_without_bound(text, says):
    Path("hostile.xacro").write_text(XACRO.format(text))
    message = read_refusal(qc.Simulation, "hostile.xacro")
    assert message.startswith("hostile.xacro:")
    assert says in message
