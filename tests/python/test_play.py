"""``quadcore play``: what it plays and what it refuses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from test_player import column_of, content_of, flown

import quadcore as qc
from quadcore.cli import main
from quadcore.report.player import PlayerFlight, make_page


@pytest.mark.usefixtures("in_empty_folder")
class TestCommand:
    def test_it_plays_logs_of_both_kinds(self):
        log = flown()
        Path("ode").mkdir()
        log.to_file("ode/log.csv")
        Path("eigen").mkdir()
        log.to_file("eigen/log.mat")
        assert main(["play", "ode/log.csv", "eigen/log.mat", "-o", "page.html", "--quiet"]) == 0
        text = Path("page.html").read_text()
        flights = content_of(text)["flights"]
        assert [flight["name"] for flight in flights] == ["ode", "eigen"]
        first, second = (column_of(text, "position", flight) for flight in (0, 1))
        assert np.array_equal(first, second)
        assert text == make_page(
            [PlayerFlight("ode", log), PlayerFlight("eigen", log)], "ode, eigen"
        )

    def test_a_guided_flight_brings_its_reference(self):
        flight = ["--engine", "eigen", "--duration", "0.5", "--log-every", "10", "--quiet"]
        guided = ["--controller", "geometric", "--reference", "circle"]
        assert main(["run", "quadrotor", *flight, *guided, "--log", "a.csv"]) == 0
        assert main(["play", "a.csv", "-o", "a.html", "--quiet"]) == 0
        circle = qc.references.circle()
        wanted = [circle(t).position for t in qc.Log.of_file("a.csv").time]
        found = column_of(Path("a.html").read_text(), "reference")[:, :3]
        assert np.allclose(found, wanted, rtol=1e-5, atol=1e-5)

    def test_the_rotors_are_the_models(self):
        flown(rotors=4).to_file("a.csv")
        assert main(["play", "a.csv", "--model", "quadrotor", "-o", "a.html", "--names", "me"]) == 0
        content = content_of(Path("a.html").read_text())
        rotors = [np.reshape(body["pose"], (4, 4)) for body in content["vehicles"][0]["bodies"][1:]]
        places = [pose[:3, 3] for pose in rotors]
        assert np.allclose(places, qc.read_model("quadrotor").joint_places, atol=1e-9)
        assert content["flights"][0]["name"] == "me"

    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            (["a.txt", "-o", "b.html"], "a.txt: logs are read from .csv, .mat, .bag, .ros2 files"),
            (["no.csv", "-o", "b.html"], "no.csv: cannot be read"),
            (["t.csv", "-o", "b.html"], "t.csv:1: this is not a log: the columns are 't,w1'"),
            (["word.csv", "-o", "b.html"], "word.csv:3: column 't' contains 'x'. Write"),
            (["nan.csv", "-o", "b.html"], "nan.csv:4: the state is not finite"),
            (["back.csv", "-o", "b.html"], "back.csv:5: the time is not later than before"),
            (["empty.csv", "-o", "b.html"], "empty.csv:2: the log has no rows"),
            (["text.mat", "-o", "b.html"], "text.mat: not a MATLAB file"),
            (["other.mat", "-o", "b.html"], "other.mat: this is not a log"),
            (["a.csv", "a.csv", "-o", "b.html"], "a.csv: is named twice. Name each log once"),
            (["a.csv", "-o", "b.txt"], "b.txt: is not a page. Name a file that ends in .html"),
            (["a.csv", "-o", "no/b.html"], "no/b.html: folder no does not exist"),
            (["a.csv", "-o", "b.html", "--names", "x,y"], "--names: 2 name(s) for 1 flight(s)"),
            (["a.csv", "-o", "b.html", "--model", "quadrotor"], "log has 3 rotors"),
        ],
    )
    def test_what_cannot_be_played_is_one_line_and_leaves_no_page(self, arguments, message, capsys):
        import scipy.io

        log = flown(rows=5, reference=False)
        log.to_file("a.csv")
        lines = Path("a.csv").read_text().splitlines()
        changed = {
            "nan.csv": [*lines[:3], lines[3].rsplit(",", 1)[0] + ",nan"],
            "back.csv": [*lines[:4], lines[2]],
            "empty.csv": lines[:1],
            "t.csv": ["t,w1", "0,1"],
            "text.mat": ["no"],
        }
        changed["word.csv"] = [*lines[:2], "x," + lines[2].split(",", 1)[1]]
        for name, content in changed.items():
            Path(name).write_text("\n".join(content) + "\n")
        scipy.io.savemat("other.mat", {"u": [1.0, 2.0]})
        assert main(["play", *arguments]) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert message in line and line.startswith("error: ")
        assert not list(Path().glob("*.html")) and not list(Path().glob(".*.part"))
