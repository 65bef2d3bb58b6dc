"""Tags that are texts, rows of numbers and files, on their way to a plugin."""

from __future__ import annotations

import shutil

import numpy as np
from faults import MODEL, refusal
from relays import element

import quadcore as qc
from quadcore.cli import main


def test_texts_numbers_and_files_reach_a_plugin_from_the_urdf_and_from_outside(relays, toy):
    def read_message(tags, **options):
        simulation = relays(element("one", publishes="push", **tags), **options)
        simulation.step()
        return simulation.topic("push")["a"], simulation.topic("push")["b"]

    folder = toy / "tables"
    folder.mkdir()
    (folder / "one.txt").write_text("10 20\n")
    assert read_message({}) == (0, 0)
    assert read_message({"own": "1 2", "table": "tables/one.txt"}) == (11, 22)
    for own in ("3 4", [3, 4], np.array([3.0, 4.0])):
        assert read_message({"own": "1 2"}, parameters={"one.own": own}) == (3, 4)
    assert read_message({}, parameters={"one.table": folder / "one.txt"}) == (10, 20)
    assert read_message({}, parameters={"one.table": "tables/one.txt"}) == (10, 20)
    assert read_message({}, parameters={"one.publishes": "push"}) == (0, 0)


def test_a_file_counts_from_the_document_that_holds_its_tag(relays, toy):
    relays()
    deep = toy / "parts" / "deep"
    deep.mkdir(parents=True)
    (deep / "one.txt").write_text("30 40")
    inner = element("one", publishes="push", table="one.txt")
    xacro = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    (deep / "part.xacro").write_text(f"<robot {xacro}>\n<gazebo>{inner}</gazebo>\n</robot>")
    include = f'<robot name="toy" {xacro}>\n<xacro:include filename="parts/deep/part.xacro"/>'
    (toy / "toy.urdf.xacro").write_text(MODEL.replace('<robot name="toy">', include))
    simulation = qc.Simulation(str(toy / "toy.urdf.xacro"))
    simulation.step()
    assert simulation.topic("push")["b"] == 40
    (deep / "one.txt").unlink()
    message = refusal(qc.Simulation, str(toy / "toy.urdf.xacro"))
    assert message.startswith(f"{deep}/part.xacro:2: plugin 'one': <table> 'one.txt' cannot be rea")


def test_info_tells_tags_of_every_kind(relays, capsys):
    relays(element("one", publishes="push", own="1 2"))
    assert main(["info", "toy.urdf", "--set", "one.own=4 5"]) == 0
    lines = capsys.readouterr().out.splitlines()
    (own,) = (line for line in lines if "one.own" in line)
    assert "4 5" in own and "0 0" in own and "--set" in own
    (table,) = (line for line in lines if "one.table" in line)
    assert "none" in table
    assert main(["info", "toy.urdf", "--set", "one.own=4 500"]) == 2
    assert (
        "set one.own: plugin 'one': <own> '4 500' contains 500, which is out of range. Write 2 "
        in (capsys.readouterr().err)
    )


def test_a_fingerprint_holds_a_file_by_its_text_and_numbers_by_their_values(relays, toy):
    (toy / "one.txt").write_text("1 2")
    tags = {"publishes": "push", "table": "one.txt"}

    def read_tags(**more):
        simulation = relays(element("one", **tags, **more))
        simulation.step()
        return simulation.snapshot()

    snapshot = read_tags(own="1 2")
    relays(element("one", **tags, own="1.0 2e0")).restore(snapshot)
    moved = toy / "moved"
    moved.mkdir()
    shutil.copy("one.txt", moved)
    shutil.copy("toy.urdf", moved)
    qc.Simulation(moved / "toy.urdf", parameters={"one.own": "1 2"}).restore(snapshot)
    message = refusal(relays(element("one", **tags, own="1 3")).restore, snapshot)
    assert "'one.own 1 2' there, 'one.own 1 3' here" in message
