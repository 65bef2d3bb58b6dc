"""Flights to watch: what the page holds, what it does, and what the command refuses."""

from __future__ import annotations

import base64
import html.parser
import json
import re
from pathlib import Path

import numpy as np
import pytest
from browser import told

import quadcore as qc
from quadcore.cli import main
from quadcore.report.player import PlayerFlight, make_page, make_section

ROTORS = np.array([[0.3, 0, 0.1], [0, 0.2, 0.1], [-0.25, -0.1, 0.12]])


def flown(rows=200, duration=4.0, reference=True, rotors=3):
    """A flight in which nothing is like anything else."""
    time = np.linspace(0, duration, rows)
    table = np.zeros((rows, 14 + rotors))
    table[:, 0] = time
    table[:, 1:4] = np.column_stack([np.cos(time), 1.5 * np.sin(time), 3 + 0.4 * time])
    table[:, 4:8] = np.column_stack([0 * time, 0 * time, np.sin(time / 2), np.cos(time / 2)])
    table[:, 14:] = np.column_stack([300 + 20 * time * (i + 1) for i in range(rotors)])
    topics = {}
    if reference:
        wanted = table[:, 1:4] + [0.02, -0.01, 0.03]
        topics["reference"] = {**dict(zip("xyz", wanted.T)), "yaw": time}
    return qc.Log(table, {}, topics=topics)


def contents_of(text):
    written = re.findall(r'<script type="application/json"[^>]*>(.*?)</script>', text, re.S)
    return list(map(json.loads, written))


def content_of(text):
    (content,) = contents_of(text)
    return content


def numbers(packed, width):
    return np.frombuffer(base64.b64decode(packed), "<f4").reshape(-1, width)


# What the page holds


class Tags(html.parser.HTMLParser):
    """Refuses tags that are closed in another order than opened; notes what would be fetched."""

    def __init__(self):
        super().__init__()
        self.opened, self.fetched = [], []

    def handle_starttag(self, tag, attrs):
        if tag not in ("meta", "input"):
            self.opened.append(tag)
        self.fetched += [value for name, value in attrs if name in ("src", "href")]

    def handle_endtag(self, tag):
        assert self.opened.pop() == tag


def test_the_page_is_well_formed_and_fetches_nothing():
    text = make_page([PlayerFlight("<b>&\"'</script>", flown())])
    tags = Tags()
    tags.feed(text)
    assert tags.opened == [] and tags.fetched == []
    for way in ("http:", "https:", "//www", "@import", "fetch(", "XMLHttp", "import("):
        assert way not in text
    assert content_of(text)["flights"][0]["name"] == "<b>&\"'</script>"


def test_data_read_back_are_the_logs():
    log = flown()
    flight = content_of(make_page([PlayerFlight("a", log, ROTORS)]))["flights"][0]
    assert np.array_equal(flight["rotors"], ROTORS)
    expected = {
        "time": log.time[:, None],
        "position": log.position,
        "orientation": log.orientation,
        "rotor_velocity": log.rotor_velocity,
        "reference": np.column_stack([log.topics["reference"][axis] for axis in "xyz"]),
    }
    assert set(flight["columns"]) == set(expected)
    for name, values in expected.items():
        assert np.array_equal(
            numbers(flight["columns"][name], values.shape[1]), values.astype("f4")
        )


def test_a_long_log_is_thinned_and_keeps_its_ends():
    log = flown(rows=100_001, reference=False)
    flight = content_of(make_page([PlayerFlight("a", log)]))["flights"][0]
    time = numbers(flight["columns"]["time"], 1)[:, 0]
    assert len(time) == 1500 and time[0] == 0 and time[-1] == 4
    assert np.ptp(np.diff(time)) < 1e-4
    assert "reference" not in flight["columns"]


def test_a_topic_that_is_called_reference_and_is_none_is_left_alone():
    log = flown(reference=False)
    log.topics["reference"] = {"volts": log.time}
    assert make_page([PlayerFlight("a", log)]) == make_page(
        [PlayerFlight("a", flown(reference=False))]
    )


def test_the_first_32_flights_look_different():
    content = content_of(make_page([PlayerFlight(str(i), flown(rows=2)) for i in range(33)]))
    assert len(content["flights"]) == 33
    assert len(set(content["colours"])) * len(set(map(tuple, content["dashes"]))) == 32


def test_equal_flights_make_equal_pages():
    assert make_page([PlayerFlight("a", flown())]) == make_page([PlayerFlight("a", flown())])


def test_a_vehicle_of_which_no_more_is_known_is_a_cross():
    flight = content_of(make_page([PlayerFlight("a", flown(rotors=4))]))["flights"][0]
    assert (
        np.allclose(np.linalg.norm(flight["rotors"], axis=1), 0.25) and len(flight["rotors"]) == 4
    )


def test_rotors_of_another_number_no_flight_and_no_row_are_refused():
    with pytest.raises(qc.InputError, match=r"rotors has shape \(3, 3\).* has 4 rotors"):
        PlayerFlight("a", flown(rotors=4), ROTORS)
    with pytest.raises(qc.InputError, match="no flight to animate"):
        make_section([])
    with pytest.raises(qc.InputError, match="'a': the log is empty"):
        PlayerFlight("a", flown(rows=0))


def test_the_joints_of_a_model_are_where_its_urdf_says():
    model = qc.read_model("quadrotor")
    assert np.array_equal(model.joint_places, [joint.xyz for joint in model.joints])
    assert np.ptp(model.joint_places[:, :2], axis=0).min() > 0.1


# What it does

LOOK = """
const canvas = document.querySelector("canvas"), slider = document.querySelector(".time");
const seen = () => canvas.toDataURL();
const cells = () => [...document.querySelectorAll("tbody tr")].map(
  (row) => [...row.cells].map((cell) => cell.textContent));
const go = (t) => { slider.value = t; slider.dispatchEvent(new Event("input")); };
const press = (key) => canvas.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
const drag = (name, x, y, id = 1) => canvas.dispatchEvent(
  new PointerEvent(name, { pointerId: id, clientX: x, clientY: y, bubbles: true }));
canvas.setPointerCapture = () => {};
"""


def test_the_slider_changes_what_is_drawn_and_told(tmp_path):
    log = flown()
    flights = [PlayerFlight("first", log, ROTORS), PlayerFlight("short", flown(duration=1.0))]
    script = (
        LOOK
        + """
    told.start = seen(); told.cells = cells();
    go(2.0); told.later = seen(); told.later_cells = cells();
    told.clock = document.querySelector(".clock").textContent;
    go(0.0); told.again = seen();
    """
    )
    found = told(make_page(flights), script, tmp_path)
    assert found["start"] == found["again"] != found["later"]
    assert [row[0] for row in found["cells"]] == ["first", "short"]
    at = [np.interp(2.0, log.time, log.position[:, i]) for i in range(3)]
    assert [float(cell) for cell in found["later_cells"][0][1].split(", ")] == pytest.approx(
        at, abs=6e-4
    )
    assert float(found["later_cells"][0][2]) == pytest.approx(np.sqrt(14) * 10, rel=1e-2)
    assert found["later_cells"][1][1].endswith("(ended)")
    assert found["clock"] == "2.00 of 4.00 s"


def test_boxes_keys_wheel_and_fingers_change_what_is_drawn(tmp_path):
    script = (
        LOOK
        + """
    const changed = (act) => { const before = seen(); act(); return before !== seen(); };
    const [first, second] = document.querySelectorAll("tbody input");
    told.box = changed(() => second.click());
    told.one = changed(() => press("1"));
    told.unchecked = !first.checked;
    told.back = changed(() => { press("1"); second.click(); });
    told.right = changed(() => press("ArrowRight"));
    told.plus = changed(() => press("+"));
    told.wheel = changed(() => canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: 90 })));
    told.orbit = changed(() => {
      drag("pointerdown", 100, 100); drag("pointermove", 150, 120); drag("pointerup", 150, 120); });
    told.pinch = changed(() => {
      drag("pointerdown", 100, 100, 1); drag("pointerdown", 200, 100, 2);
      drag("pointermove", 50, 100, 1); drag("pointerup", 50, 100, 1);
      drag("pointerup", 200, 100, 2); });
    told.follow = changed(() => document.querySelector(".follow").click());
    told.fit = changed(() => document.querySelector(".fit").click());
    told.still = !changed(() => press("q"));
    """
    )
    flights = [PlayerFlight("a", flown(), ROTORS), PlayerFlight("b", flown(reference=False))]
    found = told(make_page(flights), script, tmp_path)
    assert found and all(found.values()), found


def test_two_players_on_one_page_keep_apart(tmp_path):
    both = make_page([PlayerFlight("a", flown())]).replace(
        "</section>", "</section>" + str(make_section([PlayerFlight("b", flown(duration=1.0))])), 1
    )
    script = (
        LOOK
        + """
    go(2.0);
    told.clocks = [...document.querySelectorAll(".clock")].map((clock) => clock.textContent);
    """
    )
    assert told(both, script, tmp_path)["clocks"] == ["2.00 of 4.00 s", "0.00 of 1.00 s"]


# The command


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
        first, second = content_of(text)["flights"]
        assert (first.pop("name"), second.pop("name")) == ("ode", "eigen")
        assert first == second
        assert text == make_page(
            [PlayerFlight("ode", log), PlayerFlight("eigen", log)], "ode, eigen"
        )

    def test_a_guided_flight_brings_its_reference(self):
        flight = ["--engine", "eigen", "--duration", "0.5", "--log-every", "10", "--quiet"]
        guided = ["--controller", "geometric", "--reference", "circle"]
        assert main(["run", "quadrotor", *flight, *guided, "--log", "a.csv"]) == 0
        assert main(["play", "a.csv", "-o", "a.html", "--quiet"]) == 0
        (told_of,) = content_of(Path("a.html").read_text())["flights"]
        circle = qc.references.circle()
        wanted = [circle(t).position for t in qc.Log.of_file("a.csv").time]
        found = numbers(told_of["columns"]["reference"], 3)
        assert np.allclose(found, wanted, rtol=1e-6, atol=1e-6)

    def test_the_rotors_are_the_models(self):
        flown(rotors=4).to_file("a.csv")
        assert main(["play", "a.csv", "--model", "quadrotor", "-o", "a.html", "--names", "me"]) == 0
        (flight,) = content_of(Path("a.html").read_text())["flights"]
        assert np.array_equal(flight["rotors"], qc.read_model("quadrotor").joint_places)
        assert flight["name"] == "me"

    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            (["a.txt", "-o", "b.html"], "a.txt: logs are read from .csv, .mat, .bag files"),
            (["no.csv", "-o", "b.html"], "no.csv: cannot be read"),
            (["t.csv", "-o", "b.html"], "t.csv:1: no log of quadcore: the columns are 't,w1'"),
            (["word.csv", "-o", "b.html"], "word.csv:3: column 't' holds 'x'; write"),
            (["nan.csv", "-o", "b.html"], "nan.csv:4: the state is not finite"),
            (["back.csv", "-o", "b.html"], "back.csv:5: the time is not later than before"),
            (["empty.csv", "-o", "b.html"], "empty.csv:2: no row"),
            (["text.mat", "-o", "b.html"], "text.mat: not a MATLAB file"),
            (["other.mat", "-o", "b.html"], "other.mat: no log of quadcore"),
            (["a.csv", "a.csv", "-o", "b.html"], "a.csv: is named twice; name each log once"),
            (["a.csv", "-o", "b.txt"], "b.txt: is not a page. Name a file that ends in .html"),
            (["a.csv", "-o", "no/b.html"], "no/b.html: there is no folder no"),
            (["a.csv", "-o", "b.html", "--names", "x,y"], "--names: names 2 of 1 flights"),
            (["a.csv", "-o", "b.html", "--model", "quadrotor"], "has 3 rotors"),
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
