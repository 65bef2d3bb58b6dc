"""Wind and payloads in flights to watch."""

from __future__ import annotations

import numpy as np
from browser import told
from evaluations import FLY
from test_player import LOOK, ROTORS, content_of, contents_of, flown, numbers

import quadcore as qc
from quadcore.cli import main
from quadcore.report.player import PlayerFlight, list_animated_topics, make_page

SCENARIO = (
    "plugins:\n"
    "  drone_plugin: {dragModel: chapter2}\n"
    "  wind: {velocity: [3, -4, 0]}\n"
    "  parcel: {library: payload, mass: 0.2, xyz: [0.01, -0.02, -0.1]}\n"
    "  box: {library: payload, mass: 0.05, xyz: [0, 0.03, -0.1], topic: box}\n"
    "events: [{at: 0.3, release: parcel}, {at: 0.5, pick_up: box}]\n"
)


def befallen(tmp_path):
    (tmp_path / "storm.yaml").write_text(SCENARIO)
    return tmp_path / "storm.yaml"


def test_what_rides_and_what_blows_is_told_on_topics_and_drawn(tmp_path):
    plan = qc.FlightPlan.of(scenario=befallen(tmp_path), engine="eigen", xacro_args={"sim_slow": 1})
    simulation = plan.simulation()
    topics = list_animated_topics(simulation)
    assert sorted(topics) == ["box_carried", "payload_carried", "wind"]
    log = simulation.run(0.8, topics=topics)
    parcel, box = (log.topics[name]["mass"] for name in ("payload_carried", "box_carried"))
    began, time = log.time > 0.0015, log.time
    assert (parcel[began] == np.where(time > 0.3005, 0, 0.2)[began]).all()
    assert (box[began] == np.where(time > 0.5005, 0.05, 0)[began]).all()
    columns = content_of(make_page([PlayerFlight("a", log, None)]))["flights"][0]["columns"]
    assert np.array_equal(numbers(columns["wind"], 3)[-1], [3, -4, 0])
    riding = numbers(columns["carried payload_carried"], 4)[100]
    assert np.allclose(riding, [0.2, 0.01, -0.02, -0.1])


def weathered(wind=(3.0, -4.0, 0.0)):
    """Wind from the second row on; what is carried goes after 1 s."""
    log = flown()
    blows = np.outer(np.ones(len(log)), wind)
    blows[0] = np.nan
    log.topics["wind"] = dict(zip("xyz", blows.T))
    mass = np.where(log.time < 1, 0.25, 0.0)
    places = {axis: np.full(len(log), place) for axis, place in zip("xyz", (0, 0.02, -0.1))}
    log.topics["payload_carried"] = {"stamp": log.time, "mass": mass, **places}
    return log


def test_the_table_has_wind_and_load_and_the_picture_shows_them(tmp_path):
    script = (
        LOOK
        + """
    const shows = (column) => getComputedStyle(document.querySelector(`th.${column}`)).display;
    told.start = cells()[0].slice(3); go(0.5); told.laden = cells()[0].slice(3);
    told.picture = seen(); go(2.0); told.free = cells()[0].slice(3);
    told.shown = [shows("wind"), shows("load")];
    """
    )
    found = told(make_page([PlayerFlight("a", weathered(), ROTORS)]), script, tmp_path)
    assert found["start"] == ["", "0.25"]
    assert found["laden"] == ["5.0", "0.25"]
    assert found["free"] == ["5.0", ""]
    assert "none" not in found["shown"]
    calm = told(make_page([PlayerFlight("a", flown(), ROTORS)]), script, tmp_path)
    assert calm["shown"] == ["none", "none"]
    other = told(make_page([PlayerFlight("a", weathered((0, 4, 0)), ROTORS)]), script, tmp_path)
    assert len({found["picture"], calm["picture"], other["picture"]}) == 3


def test_the_page_of_an_evaluation_has_them(tmp_path):
    command = [*FLY, "--controller", "geometric", "--reference", "hover", "--engine", "eigen"]
    scenarios = ["--scenario", f"none,{befallen(tmp_path)}"]
    assert main([*command, *scenarios, "--out", str(tmp_path / "out"), "--quiet"]) == 0
    text = (tmp_path / "out" / "report.html").read_text()
    assert "Animation: hover, scenario none" in text
    contents = [content["flights"] for content in contents_of(text)]
    columns = [set(flight["columns"]) for (flight,) in contents]  # a player for each scenario
    assert "wind" not in columns[0]
    assert {"wind", "carried box_carried", "carried payload_carried"} <= columns[1]
