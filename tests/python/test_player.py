"""Flights to watch: what the page holds, shows and does."""

from __future__ import annotations

import base64
import functools
import html.parser
import json
import re
import zlib

import numpy as np
import pytest
from browser import find_violations, run_script_when_ready
from scipy.spatial.transform import Rotation, Slerp

import quadcore as qc
from quadcore.model.visuals import read_vehicle
from quadcore.report.colours import curve_style
from quadcore.report.drawn_vehicle import DrawnShape, DrawnWorld
from quadcore.report.packing import choose_rows, make_plot_times, pick_extremes
from quadcore.report.player import PlayerFlight, make_page, make_section

HOSTILE = "</script><img src=x onerror=faults.push('ran')>&\"'"


def flown(rows=200, duration=4.0, reference=True, rotors=3, shift=0.0):
    """A flight in which nothing is like anything else."""
    time = np.linspace(0, duration, rows)
    table = np.zeros((rows, 14 + rotors))
    table[:, 0] = time
    table[:, 1:4] = np.column_stack([np.cos(time) + shift, 1.5 * np.sin(time), 3 + 0.4 * time])
    table[:, 4:8] = np.column_stack([0 * time, 0 * time, np.sin(time / 2), np.cos(time / 2)])
    table[:, 14:] = np.column_stack([300 + 20 * time * (i + 1) for i in range(rotors)])
    topics = {}
    if reference:
        wanted = table[:, 1:4] + [0.02, -0.01, 0.03]
        topics["reference"] = {**dict(zip("xyz", wanted.T)), "yaw": time}
    return qc.Log(table, {}, topics=topics)


def multiply(one, other):
    """Hamilton product of quaternions x, y, z, w."""
    (x, y, z, w), (a, b, c, d) = one, other
    return [w * a + x * d + y * c - z * b, w * b - x * c + y * d + z * a,
            w * c + x * b - y * a + z * d, w * d - x * a - y * b - z * c]  # fmt: skip


@functools.lru_cache(maxsize=None)
def tumbling(duration=30.0, dt=1e-3):
    """Rotation at up to 20 rad/s about a changing axis, on a winding path."""
    time = np.arange(0, duration + dt / 2, dt)
    steps = np.column_stack([12 * np.sin(1.3 * time), 14 * np.cos(0.7 * time), 8 + 0 * time]) * dt
    turned = np.zeros((len(time), 4))
    turned[0, 3] = 1
    for row, (step, angle) in enumerate(zip(steps[:-1], np.linalg.norm(steps[:-1], axis=1))):
        turned[row + 1] = multiply(
            turned[row], [*(np.sin(angle / 2) / angle * step), np.cos(angle / 2)]
        )
    table = np.zeros((len(time), 18))
    table[:, 0], table[:, 4:8] = time, turned
    table[:, 1:4] = np.column_stack(
        [4 * np.sin(time) + np.sin(5 * time), 4 * np.cos(0.8 * time), 10 + np.sin(3 * time)]
    )
    table[:, 14:] = 400 + 30 * np.sin(7 * time)[:, None]
    return qc.Log(table)


def contents_of(text):
    written = re.findall(r'<script type="application/json"[^>]*>(.*?)</script>', text, re.S)
    return list(map(json.loads, written))


def content_of(text):
    (content,) = contents_of(text)
    return content


def numbers_of(text):
    """All numbers of the first player of a page."""
    packed = re.search(r'<script type="text/plain" class="numbers">(.*?)</script>', text).group(1)
    planes = np.frombuffer(zlib.decompress(base64.b64decode(packed)), np.uint8).reshape(4, -1)
    return np.frombuffer(planes.T.tobytes(), "<f4")


def column_of(text, name, flight=0):
    column = content_of(text)["flights"][flight]["columns"][name]
    at = column["values"]
    found = numbers_of(text)[at["at"] : at["at"] + at["count"]]
    return found.reshape(-1, column["width"])


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


def test_the_page_is_well_formed_and_names_no_other_file():
    text = make_page([PlayerFlight(HOSTILE, flown())], HOSTILE)
    tags = Tags()
    tags.feed(text)
    assert tags.opened == [] and tags.fetched == []
    assert content_of(text)["flights"][0]["name"] == HOSTILE


def test_numbers_read_back_are_those_of_the_log():
    log = flown()
    text = make_page([PlayerFlight("a", log)])
    expected = {
        "time": (log.time[:, None], 1e-6),
        "position": (log.position, 1e-5),
        "orientation": (log.orientation, 1e-5),
        "rotor_velocity": (log.rotor_velocity, 0.01),
        "reference": (np.column_stack(list(log.topics["reference"].values())), 1e-5),
    }
    assert set(content_of(text)["flights"][0]["columns"]) == set(expected)
    for name, (values, error) in expected.items():
        assert np.abs(column_of(text, name) - values).max() < error


def test_rows_are_dense_where_the_vehicle_turns():
    log = tumbling()
    rows = choose_rows(log.time, log.position, log.orientation)
    assert rows[0] == 0 and rows[-1] == len(log) - 1 and len(rows) < 4000
    between = Slerp(log.time[rows], Rotation.from_quat(log.orientation[rows]))(log.time)
    turned = (between.inv() * Rotation.from_quat(log.orientation)).magnitude()
    assert turned.max() < 4.1e-4
    for axis in range(3):
        drawn = np.interp(log.time, log.time[rows], log.position[rows, axis])
        assert np.abs(drawn - log.position[:, axis]).max() < 4.1e-4
    still = np.zeros((10_000, 3))
    assert len(choose_rows(np.arange(10_000.0), still, np.tile([0, 0, 0, 1.0], (10_000, 1)))) == 600


def test_plots_keep_every_peak_and_no_beat():
    time = np.arange(0, 10, 1e-3)
    ripple = 1e-5 * np.sin(2 * np.pi * 99.7 * time)
    ripple[4321] = 3e-5
    drawn = pick_extremes(time, ripple, 0.0, 10.0)
    assert len(drawn) == len(make_plot_times(0, 10)) and np.nanmax(drawn) == 3e-5
    # Twenty samples a bucket find both ends of each ripple; every 10th row would find a beat.
    assert (drawn.reshape(-1, 2).max(axis=1) > 0.9e-5).all()
    assert (drawn.reshape(-1, 2).min(axis=1) < -0.9e-5).all()
    short = pick_extremes(time[:5000], ripple[:5000], 0.0, 10.0)
    assert np.isfinite(short[:500]).all() and np.isnan(short[501:]).all()


def test_a_topic_that_is_called_reference_and_is_none_is_left_alone():
    log = flown(reference=False)
    log.topics["reference"] = {"volts": log.time}
    assert make_page([PlayerFlight("a", log)]) == make_page(
        [PlayerFlight("a", flown(reference=False))]
    )


def test_equal_flights_make_equal_pages():
    vehicle = read_vehicle(qc.read_model("quadrotor"))
    one, other = ([PlayerFlight("a", flown(rotors=4), vehicle)] for _ in range(2))
    assert make_page(one) == make_page(other)


def test_another_vehicle_no_flight_and_no_row_are_refused():
    vehicle = read_vehicle(qc.read_model("quadrotor"))
    with pytest.raises(qc.InputError, match=r"the log has 3 rotors, but .* 'quadrotor' has 4"):
        PlayerFlight("a", flown(rotors=3), vehicle)
    with pytest.raises(qc.InputError, match="no flight to animate"):
        make_section([])
    with pytest.raises(qc.InputError, match="'a': the log is empty"):
        PlayerFlight("a", flown(rows=0))
    with pytest.raises(qc.InputError, match=r"camera 'behind' is unknown. Use one of follow, "):
        make_page([PlayerFlight("a", flown())], camera="behind")


def test_pages_are_small_and_have_the_licences():
    vehicle = read_vehicle(qc.read_model("quadrotor"))
    pages = {
        count: make_page([PlayerFlight(f"flight {i}", tumbling(), vehicle) for i in range(count)])
        for count in (2, 12)
    }
    assert len(pages[2]) < 0.6e6 and len(pages[12]) < 1.6e6
    for owner in ("three.js authors", "Leon Sorokin", "Matt DesLauriers"):
        assert owner in pages[2]


# What it shows and does

HELP = """
const player = quadcore.players[0], { scene } = player;
const seen = () => { scene.render(); return scene.canvas.toDataURL(); };
const cells = () => [...document.querySelectorAll(".flights tbody tr")].map(
  (row) => [...row.cells].map((cell) => cell.textContent));
const press = (key, at = document.body) =>
  at.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
const changed = (act) => { const before = seen(); act(); return before !== seen(); };
"""


def test_the_pose_shown_is_that_of_the_log_and_nothing_is_requested(tmp_path):
    log = tumbling()
    times = np.random.default_rng(5).uniform(0, 30, 10)
    script = (
        f"{HELP}const times = {times.tolist()};"
        + """
    result.poses = times.map((t) => {
      player.go(t);
      const { root } = scene.actors[0].vehicle;
      root.updateMatrixWorld(true);
      return [root.position.toArray(), root.quaternion.toArray()];
    });
    result.requests = performance.getEntriesByType("resource").map((entry) => entry.name);
    """
    )
    vehicle = read_vehicle(qc.read_model("quadrotor"))
    found = run_script_when_ready(make_page([PlayerFlight("a", log, vehicle)]), script, tmp_path)
    assert found["requests"] == []
    turned = Slerp(log.time, Rotation.from_quat(log.orientation))(times)
    for number, (position, orientation) in enumerate(found["poses"]):
        at = [np.interp(times[number], log.time, log.position[:, axis]) for axis in range(3)]
        assert np.linalg.norm(np.subtract(position, at)) < 1e-3
        apart = Rotation.from_quat(orientation).inv() * turned[number]
        assert apart.magnitude() < 1e-3


@pytest.mark.parametrize("count", [2, 12, 40])
def test_every_flight_has_a_vehicle_a_legend_entry_and_its_colour(count, tmp_path):
    flights = [PlayerFlight(f"{HOSTILE} {i}", flown(shift=0.1 * i)) for i in range(count)]
    script = (
        HELP
        + """
    result.vehicles = scene.actors.filter(({ vehicle }) => vehicle.root.visible).length;
    result.names = cells().map((row) => row[0]);
    result.colours = [...document.querySelectorAll(".swatch line")].map((line) =>
      [line.getAttribute("stroke"), line.getAttribute("stroke-dasharray")]);
    result.curves = player.plots.plots[0].series.slice(1).map((one) => one._stroke || one.stroke());
    result.images = document.images.length;
    """
    )
    found = run_script_when_ready(make_page(flights), script, tmp_path)
    assert found["vehicles"] == count and found["images"] == 0
    assert found["names"] == [flight.name for flight in flights]
    expected = [curve_style(i)["color"] for i in range(count)]
    assert [colour for colour, _ in found["colours"]] == expected == found["curves"]
    assert len(set(map(tuple, found["colours"]))) == count


def test_the_table_follows_the_time(tmp_path):
    log = flown()
    flights = [PlayerFlight("first", log), PlayerFlight("short", flown(duration=1.0))]
    script = (
        HELP
        + """
    const slider = document.querySelector(".time");
    result.start = seen(); slider.value = 2; slider.dispatchEvent(new Event("input"));
    result.later = seen(); result.cells = cells();
    result.clock = document.querySelector(".clock").textContent;
    player.go(0); result.again = seen();
    """
    )
    found = run_script_when_ready(make_page(flights), script, tmp_path)
    assert found["start"] == found["again"] != found["later"]
    at = [np.interp(2.0, log.time, log.position[:, i]) for i in range(3)]
    assert [float(cell) for cell in found["cells"][0][1].split(", ")] == pytest.approx(at, abs=6e-4)
    assert float(found["cells"][0][2]) == pytest.approx(np.sqrt(14) * 10, rel=1e-2)
    assert found["cells"][1][1].endswith("(ended)")
    assert found["clock"] == "2.00 of 4.00 s"


def test_keys_boxes_cameras_and_plots_change_what_is_drawn(tmp_path):
    script = (
        HELP
        + """
    const [first, second] = document.querySelectorAll(".flights input");
    const tick = (name) => document.querySelector(name).click();
    result.box = changed(() => second.click());
    result.one = changed(() => press("1"));
    result.unchecked = !first.checked;
    result.back = changed(() => { press("1"); second.click(); });
    result.right = changed(() => press("ArrowRight"));
    result.plus = changed(() => press("+"));
    for (const name of ["trails", "reference", "thrust"])
      result[name] = changed(() => tick(`.show-${name}`));
    for (let i = 0; i < 5; ++i) result[`camera ${i}`] = changed(() => press("c"));
    result.follow = changed(() => document.querySelectorAll(".flights button")[1].click());
    await new Promise((resolve) => setTimeout(resolve, 50));  // the plots are drawn anew
    result.plot = changed(() => {
      const { left, width, top } = player.plots.plots[0].over.getBoundingClientRect();
      player.plots.plots[0].over.dispatchEvent(new PointerEvent(
        "pointerdown", { clientX: left + width / 2, clientY: top + 9, bubbles: true }));
    });
    result.middle = Math.abs(player.time - 2) < 0.05;
    result.still = !changed(() => press("q"));
    press(" "); result.plays = player.playing; press(" "); result.stops = !player.playing;
    result.typed = !changed(() => press("1", document.querySelector("select.speed")));
    """
    )
    flights = [PlayerFlight("a", flown()), PlayerFlight("b", flown(reference=False, shift=1))]
    found = run_script_when_ready(make_page(flights), script, tmp_path)
    assert found and all(found.values()), found


def test_each_change_is_drawn_once_with_the_next_frame(tmp_path):
    script = (
        HELP
        + """
    const settle = () => new Promise(
      (done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    const drawn = () => scene.renderer.info.render.frame;
    const count = async (change) => {
      await settle();
      const before = drawn();
      change();
      await settle();
      return drawn() - before === 1;
    };
    result.time = await count(() => player.go(1));
    result.camera = await count(() => scene.setCamera("top"));
    result.zoom = await count(() => scene.zoom(0.9));
    result.box = await count(() => document.querySelector(".show-trails").click());
    result.two = await count(() => { player.go(2); scene.zoom(1.1); });
    await settle();
    const before = drawn();
    await settle();
    result.rests = drawn() === before;
    """
    )
    found = run_script_when_ready(make_page([PlayerFlight("a", flown())]), script, tmp_path)
    assert len(found) == 6 and all(found.values()), found


def test_it_plays_loops_and_follows_the_speed(tmp_path):
    script = (
        HELP
        + """
    let now = 0, frames = [];
    window.requestAnimationFrame = (draw) => frames.push(draw);
    const pass = (ms) => { now += ms; for (const draw of frames.splice(0)) draw(now); };
    document.querySelector(".speed").value = "0.5";
    player.play(true); pass(0); pass(1000); result.slow = player.time;
    document.querySelector(".speed").value = "10";
    pass(100); result.fast = player.time;
    pass(1000); result.ended = [player.time, player.playing];
    document.querySelector(".loop").checked = true;
    player.go(3.9); player.play(true); pass(1); pass(1000);
    result.looped = [player.time, player.playing];
    """
    )
    found = run_script_when_ready(make_page([PlayerFlight("a", flown())]), script, tmp_path)
    assert found["slow"] == pytest.approx(0.5) and found["fast"] == pytest.approx(1.5)
    assert found["ended"] == [4.0, False] and found["looped"] == [0.0, True]


def test_a_link_opens_at_a_moment_and_obstacles_and_ground_stand_in_the_world(tmp_path):
    pose = np.eye(4)
    pose[:3, 3] = [1, 2, 3]
    kinds = {"box": (1, 2, 3), "cylinder": (0.5, 2), "sphere": (0.7,)}
    world = DrawnWorld(True, [DrawnShape(kind, size, pose) for kind, size in kinds.items()])
    script = (
        HELP
        + """
    result.boxes = scene.obstacles.map((obstacle) => {
      obstacle.geometry.computeBoundingBox();
      const { min, max } = obstacle.geometry.boundingBox;
      return [max.x - min.x, max.y - min.y, max.z - min.z, ...obstacle.position.toArray()];
    });
    result.floor = scene.floor;
    """
    )
    found = run_script_when_ready(
        make_page([PlayerFlight("a", flown())], world=world), script, tmp_path
    )
    assert found["floor"] == 0
    sizes = [(1, 2, 3), (1, 1, 2), (1.4, 1.4, 1.4)]
    assert np.allclose(found["boxes"], [[*size, 1, 2, 3] for size in sizes], atol=1e-6)


def test_a_gif_has_frames_of_the_flight(tmp_path):
    from io import BytesIO

    from PIL import Image, ImageChops

    script = (
        HELP
        + """
    const bytes = player.makeGif();
    result.gif = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
    """
    )
    flight = PlayerFlight("a", flown(duration=0.4))
    found = run_script_when_ready(make_page([flight], camera="whole"), script, tmp_path)
    image = Image.open(BytesIO(base64.b64decode(found["gif"])))
    assert image.size == (560, 360) and image.n_frames == 7
    first = image.convert("RGB")
    image.seek(6)
    assert ImageChops.difference(first, image.convert("RGB")).getbbox() is not None


def test_two_players_on_one_page_keep_apart(tmp_path):
    sections = [make_section([PlayerFlight(name, flown(duration=end))])
                for name, end in (("a", 4.0), ("b", 1.0))]  # fmt: skip
    page = make_page([PlayerFlight("a", flown())])
    both = page.replace(str(sections[0]), str(sections[0]) + str(sections[1]))
    script = """
    quadcore.players.find((player) => player.end > 2).go(2);
    result.clocks = [...document.querySelectorAll(".clock")].map((clock) => clock.textContent);
    """
    found = run_script_when_ready(both, script, tmp_path)
    assert found["clocks"] == ["2.00 of 4.00 s", "0.00 of 1.00 s"]


@pytest.mark.parametrize("dark", [False, True])
def test_axe_finds_nothing_serious(dark, tmp_path):
    flights = [PlayerFlight("a", flown()), PlayerFlight("b", flown(shift=1.0))]
    assert find_violations(make_page(flights), tmp_path, dark) == []
