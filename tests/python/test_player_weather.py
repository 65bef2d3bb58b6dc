"""Wind and payloads in flights to watch."""

from __future__ import annotations

import numpy as np
from browser import run_script_when_ready
from evaluations import FLY
from test_player import HELP, column_of, contents_of, flown

import quadcore as qc
from quadcore.cli import main
from quadcore.report.player import PlayerFlight, make_page
from quadcore.report.player_flight import list_animated_topics

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


def test_payload_and_wind_are_published_and_drawn(tmp_path):
    plan = qc.FlightPlan.of(scenario=befallen(tmp_path), engine="eigen", xacro_args={"sim_slow": 1})
    simulation = plan.simulation()
    topics = list_animated_topics(simulation)
    assert sorted(topics) == ["box_carried", "payload_carried", "wind"]
    log = simulation.run(0.8, topics=topics)
    parcel, box = (log.topics[name]["mass"] for name in ("payload_carried", "box_carried"))
    began, time = log.time > 0.0015, log.time
    assert (parcel[began] == np.where(time > 0.3005, 0, 0.2)[began]).all()
    assert (box[began] == np.where(time > 0.5005, 0.05, 0)[began]).all()
    page = make_page([PlayerFlight("a", log, None)])
    assert np.array_equal(column_of(page, "wind")[-1], [3, -4, 0])
    riding = column_of(page, "payload payload_carried")[100]
    assert np.allclose(riding, [0.2, 0.01, -0.02, -0.1])


def make_weathered_log():
    """Wind from the second row on; what is carried goes after 1 s."""
    log = flown()
    blows = np.outer(np.ones(len(log)), [3.0, -4.0, 0.0])
    blows[0] = np.nan
    log.topics["wind"] = dict(zip("xyz", blows.T))
    mass = np.where(log.time < 1, 0.25, 0.0)
    places = {axis: np.full(len(log), place) for axis, place in zip("xyz", (0, 0.02, -0.1))}
    log.topics["payload_carried"] = {"stamp": log.time, "mass": mass, **places}
    return log


def test_table_and_scene_show_wind_and_payload(tmp_path):
    script = (
        HELP
        + """
    const shows = (column) => getComputedStyle(document.querySelector(`th.${column}`)).display;
    const look = () => ({
      row: cells()[0].slice(3, 5),
      wind: scene.actors[0].wind.arrow.visible,
      payload: scene.actors[0].payloads.map((payload) => payload.group.visible),
    });
    const lookAt = (t) => { player.go(t); scene.render(); return look(); };
    result.start = lookAt(0); result.laden = lookAt(0.5); result.free = lookAt(2);
    result.shown = [shows("wind"), shows("load")];
    result.plots = player.plots.content.map((panel) => panel.name);
    """
    )
    found = run_script_when_ready(
        make_page([PlayerFlight("a", make_weathered_log())]), script, tmp_path
    )
    assert found["start"] == {"row": ["", "0.25"], "wind": False, "payload": [True]}
    assert found["laden"] == {"row": ["5.0", "0.25"], "wind": True, "payload": [True]}
    assert found["free"] == {"row": ["5.0", ""], "wind": True, "payload": [False]}
    assert "none" not in found["shown"] and "Wind speed (m/s)" in found["plots"]
    script = (
        HELP
        + """
    result.shown = ["wind", "load"].map(
      (column) => getComputedStyle(document.querySelector(`th.${column}`)).display);
    """
    )
    calm = run_script_when_ready(make_page([PlayerFlight("a", flown())]), script, tmp_path)
    assert calm["shown"] == ["none", "none"]


def test_the_page_of_an_evaluation_has_them(tmp_path):
    command = [*FLY, "--controller", "geometric", "--reference", "hover", "--engine", "eigen"]
    scenarios = ["--scenario", f"none,{befallen(tmp_path)}"]
    assert main([*command, *scenarios, "--out", str(tmp_path / "out"), "--quiet"]) == 0
    text = (tmp_path / "out" / "report.html").read_text()
    assert "Animation: hover, scenario none" in text
    contents = [content["flights"] for content in contents_of(text)]
    columns = [set(flight["columns"]) for (flight,) in contents]  # a player for each scenario
    assert "wind" not in columns[0]
    assert {"wind", "payload box_carried", "payload payload_carried"} <= columns[1]
