"""Files that a user or a model names: pipes, devices, sockets and folders are refused at once."""

import os
import socket
from pathlib import Path

import pytest

import quadcore as qc
from quadcore.cli import main

FLIGHT = ["run", "quadrotor", "--duration", "0.01"]
GUIDED = [*FLIGHT, "--controller", "pd", "--reference"]
READERS = {
    "model": ["run", "odd.urdf"],
    "xacro": ["run", "odd.xacro"],
    "world": [*FLIGHT, "--world", "odd.world"],
    "scenario": [*FLIGHT, "--scenario", "odd.yaml"],
    "commands": [*FLIGHT, "--commands", "odd.csv"],
    "commands of MATLAB": [*FLIGHT, "--commands", "odd.mat"],
    "commands in a bag": [*FLIGHT, "--commands", "odd.bag"],
    "gains": [*FLIGHT, "--reference", "hover", "--controller", "odd.yaml"],
    "rows": [*GUIDED, "odd.csv"],
    "rows in YAML": [*GUIDED, "odd.yaml"],
    "rows of MATLAB": [*GUIDED, "odd.mat"],
    "log to plot": ["plot", "odd.csv"],
    "log to play": ["play", "-o", "page.html", "odd.csv"],
    "log to fit": ["fit", "quadrotor", "--free", "frame.mass", "-o", "f.urdf", "--log", "odd.csv"],
    "options": ["evaluate", "odd.yaml"],
    "points": ["sweep", "--controller", "pd", "--reference", "hover", "--points", "odd.csv"],
}


@pytest.fixture(autouse=True)
def _folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def make_device(name):
    os.symlink("/dev/zero", name)


def make_socket(name):
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(name)


@pytest.mark.parametrize("make", [os.mkfifo, make_device, make_socket])
@pytest.mark.parametrize("reader", READERS)
def test_what_could_be_read_without_end_is_refused_in_one_line(reader, make, capsys):
    name = READERS[reader][-1]
    make(name)
    assert main(READERS[reader]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and f"{name}: this is not a regular file" in said


@pytest.mark.parametrize("reader", READERS)
def test_a_folder_is_refused_in_one_line(reader, capsys):
    name = READERS[reader][-1]
    os.mkdir(name)
    assert main(READERS[reader]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and name in said


PLUGIN = '<plugin name="odd" filename="lib{}_plugin.so">{}</plugin>'


@pytest.mark.parametrize("make", [os.mkfifo, make_device])
@pytest.mark.parametrize(
    ("plugin", "name", "tags"),
    [
        ("controller", "odd.yaml", "<law>pd</law><gains>odd.yaml</gains>"),
        ("controller", "odd.urdf", "<law>pd</law><belief>odd.urdf</belief>"),
        ("reference", "odd.csv", "<shape>series</shape><rows>odd.csv</rows>"),
    ],
)
def test_a_tag_names_no_pipe_and_no_device(plugin, name, tags, make):
    make(name)
    text = qc.read_model("quadrotor").document.text
    assert "</gazebo>" in text
    added = f"{PLUGIN.format(plugin, tags)}</gazebo>"
    Path("a.urdf").write_text(text.replace("</gazebo>", added, 1))
    with pytest.raises(qc.InputError, match=f"'{name}' is not a regular file"):
        qc.Simulation("a.urdf")


def test_a_file_that_a_xacro_loads_is_no_pipe():
    os.mkfifo("odd.yaml")
    Path("a.xacro").write_text(
        '<robot name="a" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '<xacro:property name="p" value="${xacro.load_yaml(\'odd.yaml\')}"/>\n'
        '<link name="${p.b}"/></robot>'
    )
    with pytest.raises(qc.InputError, match="is not a regular file"):
        qc.read_model("a.xacro")


def test_a_yaml_file_has_a_largest_size(monkeypatch, capsys):
    with open("big.yaml", "wb") as file:
        file.truncate(10**7 + 1)
    assert main([*GUIDED[:-1], "--reference", "hover", "--scenario", "big.yaml"]) == 2
    assert (
        "big.yaml: the file exceeds the limit of 10 MB. Use a smaller file."
        in capsys.readouterr().err
    )
