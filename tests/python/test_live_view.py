"""Pages served on this machine: flights that go on, and views of logs and simulations."""

from __future__ import annotations

import http.client
import json
import os
import signal
import subprocess
import sys
import threading
import urllib.error
import urllib.request

import numpy as np
import pytest
from browser import run_script_when_ready
from test_player import content_of, flown

import quadcore as qc
from quadcore.report.page_server import PageServer
from quadcore.simulation.flight import fly, list_columns
from quadcore.simulation.live_view import LiveView
from quadcore.simulation.view import View


def ask(server, path="/", **headers):
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=20)
    connection.request("GET", path, headers=headers)
    return connection.getresponse()


def read_events(server, **headers):
    """All rows and the reason of the end that a page receives."""
    rows, kind = [], ""
    for line in ask(server, "/events", **headers):
        name, _, value = line.decode().rstrip("\n").partition(": ")
        if name == "event":
            kind = value
        elif name == "data" and kind == "rows":
            event = json.loads(value)
            assert event["first"] == (rows[-1][0] + 1 if rows else event["first"])
            rows += [[event["first"] + i, *row] for i, row in enumerate(event["rows"])]
        elif name == "data" and kind == "end":
            return rows, json.loads(value)["reason"]
    raise AssertionError("the stream broke off")


def test_a_late_page_gets_all_rows_once_and_a_reconnect_doubles_none():
    server = PageServer("<html></html>")
    server.append([[0.0], [0.1]])
    early = []
    thread = threading.Thread(target=lambda: early.extend(read_events(server)[0]))
    thread.start()
    server.append([[0.2], [None]])
    server.end("done")
    thread.join(20)
    expected = [[0, 0.0], [1, 0.1], [2, 0.2], [3, None]]
    assert early == expected and read_events(server) == (expected, "done")
    assert read_events(server, **{"Last-Event-ID": "3"}) == (expected[3:], "done")
    server.wait_for_pages(0.0)
    server.close()


def test_a_page_that_reads_nothing_does_not_delay_the_flight():
    server = PageServer("<html></html>")
    stuck = ask(server, "/events")
    rows = [[float(i)] * 30 for i in range(1000)]
    for _ in range(100):
        server.append(rows)  # more than a socket holds; returns at once, or the test would hang
    server.end()
    assert len(read_events(server)[0]) == 100_000
    stuck.close()
    server.close()


def test_a_page_that_closes_is_forgotten_and_the_flight_goes_on():
    server = PageServer("<html></html>")
    server.append([[0.0]])

    def send(text):
        raise BrokenPipeError

    with pytest.raises(BrokenPipeError):
        server.stream(0, send)
    server.append([[0.1]])
    server.end()
    assert read_events(server)[0] == [[0, 0.0], [1, 0.1]]
    server.wait_for_pages(600.0)  # the test would hang if it waited for the closed page
    server.close()


def test_a_flight_at_real_time_is_shown_less_than_a_fifth_of_a_second_late():
    simulation = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
    live = LiveView(simulation, list_columns(simulation))
    times, missing = [], []

    def receive(table, wrenches):
        live.receive(table, wrenches)
        times.append(simulation.time)
        missing.append(simulation.time - live.page._rows[-1][0])

    fly(simulation, 0.5, None, 1, receive, pace=1.0)
    live.close()
    live.page.close()
    # A row waits for the end of its piece, and the page for the next row that it gets.
    assert times[-1] == pytest.approx(0.5)
    assert np.diff(times).max() + max(missing) < 0.1


def test_only_this_machine_is_answered_and_only_the_page_is_there():
    server = PageServer("<html>é</html>")
    assert ask(server).read().decode() == "<html>é</html>"
    assert ask(server, Host="evil.example").status == 403
    assert ask(server, "/../etc/passwd").status == 404
    request = urllib.request.Request(server.url, data=b"x")
    with pytest.raises(urllib.error.HTTPError, match="501"):
        urllib.request.urlopen(request)
    with pytest.raises(qc.InputError, match=f"port {server.port}: cannot be used"):
        PageServer("", server.port)
    server.close()


def test_the_page_of_a_flight_shows_its_rows(tmp_path):
    simulation = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
    live = LiveView(simulation, list_columns(simulation), log_every=1)
    log = simulation.run(1.0, controller="geometric", reference="hover")
    live.receive(log.table[:400], np.empty((0, 0, 6)))
    live.receive(log.table[400:], np.empty((0, 0, 6)))
    live.close()
    page = ask(live.page).read().decode()
    assert content_of(page)["live"] == "/events"
    script = """
    const [player] = quadcore.players;
    while (player.isLive) await new Promise((resolve) => setTimeout(resolve, 20));
    await new Promise((resolve) => setTimeout(resolve, 200));
    result.rows = player.flights[0].rows; result.end = player.end; result.time = player.time;
    result.state = document.querySelector(".state").textContent;
    result.plots = player.plots.content.map((panel) => panel.name);
    """
    # The page from disk may not ask a server: the events go in as the server would send them.
    rows, _ = read_events(live.page)
    source = f"""<script>
    window.EventSource = class {{
      addEventListener(name, act) {{
        const data = name === "rows"
          ? {{ flight: 0, first: 0, rows: {json.dumps([row[1:] for row in rows])} }}
          : {{ reason: "" }};
        for (const delay of [0, 1]) setTimeout(() => act({{ data: JSON.stringify(data) }}), delay);
      }}
      close() {{}}
    }};</script>"""
    found = run_script_when_ready(page.replace("<head>", "<head>" + source, 1), script, tmp_path)
    assert len(rows) == 1 + 1000 // 17 + 1 and found["rows"] == len(rows)
    assert rows[-1][1] == 1.0
    assert found["end"] == found["time"] == pytest.approx(rows[-1][1])
    assert found["state"] == "the flight has ended"
    assert found["plots"] == ["Height (m)", "Rotor speed (rad/s)"]
    live.page.close()


def test_run_shows_the_flight_and_waits_for_the_page(tmp_path):
    command = [sys.executable, "-m", "quadcore", "run", "quadrotor", "--engine", "eigen"]
    flight = ["--duration", "0.5", "--xacro", "sim_slow:=1", "--controller", "geometric"]
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "BROWSER")}
    with subprocess.Popen(
        [*command, *flight, "--live", "--pace", "0"], env=environment, cwd=str(tmp_path),
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    ) as process:  # fmt: skip
        url = next(line for line in process.stderr if "live view" in line).split()[-1]
        with urllib.request.urlopen(url + "events", timeout=60) as events:
            text = events.read().decode()
        assert process.wait(60) == 0
    rows = [row for line in text.splitlines() if line.startswith("data: {\"flight\"")
            for row in json.loads(line[6:])["rows"]]  # fmt: skip
    assert rows[0][0] == 0 and rows[-1][0] == 0.5
    assert len({row[0] for row in rows}) == len(rows)


def test_a_page_that_reads_slowly_gets_the_tail_of_a_fast_flight():
    server = PageServer("<html></html>")
    server.append([[float(i)] * 30 for i in range(100_000)])
    server.end()
    events = ask(server, "/events")
    events.read(100)
    waiting = threading.Thread(target=server.wait_for_pages, args=(0.0,))
    waiting.start()
    waiting.join(0.5)
    assert waiting.is_alive()
    assert b"event: end" in events.read()
    waiting.join(20)
    assert not waiting.is_alive()
    server.close()


def test_a_flight_that_fails_waits_for_its_page(tmp_path):
    (tmp_path / "quits.py").write_text(
        "def controller(t, state, reference):\n    return [471, -471, 471, -471][: 4 - (t > 0.3)]\n"
    )
    command = [sys.executable, "-m", "quadcore", "run", "quadrotor", "--engine", "eigen"]
    flight = ["--duration", "0.5", "--controller", "quits.py", "--live", "--pace", "0"]
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "BROWSER")}
    with subprocess.Popen(
        [*command, *flight], env=environment, cwd=str(tmp_path),
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    ) as process:  # fmt: skip
        url = next(line for line in process.stderr if "live view" in line).split()[-1]
        with urllib.request.urlopen(url + "events", timeout=60) as events:
            text = events.read().decode()
        assert process.wait(60) == 3
    assert "event: end" in text and '"rows": [[0.0' in text


def test_a_live_view_opens_after_all_inputs_were_checked(tmp_path):
    page = tmp_path / "opened"
    browser = f"{sys.executable} -c \"open('{page}', 'w')\" %s"
    command = [sys.executable, "-m", "quadcore", "run", "quadrotor", "--live", "--duration", "0.01"]
    done = subprocess.run(
        [*command, "--log", "log.txt"], env={**os.environ, "BROWSER": browser}, cwd=str(tmp_path),
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 2 and "log.txt" in done.stderr
    assert "live view" not in done.stderr and not page.exists()


def test_play_serves_a_page_until_it_is_stopped(tmp_path):
    flown().to_file(tmp_path / "log.csv")
    command = [sys.executable, "-m", "quadcore", "play", "log.csv"]
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "BROWSER")}
    with subprocess.Popen(
        command, env=environment, cwd=str(tmp_path), stdout=subprocess.PIPE, text=True
    ) as process:
        url = process.stdout.readline().split()[1]
        with urllib.request.urlopen(url, timeout=60) as page:
            assert content_of(page.read().decode())["flights"][0]["name"] == "log"
        process.send_signal(signal.SIGINT)
        assert process.wait(60) == 130
    assert [path.name for path in tmp_path.iterdir()] == ["log.csv"]


def test_a_view_of_a_simulation_has_each_state_that_was_synchronised(tmp_path):
    simulation = qc.Simulation("quadrotor", engine="eigen", spawn=(1, 2, 3))
    shown = qc.view(simulation, browser=False)
    for _ in range(4):
        simulation.step(20)
        shown.sync()
    shown.sync()
    shown.save(tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text()
    assert content_of(text)["flights"][0]["columns"]["time"]["values"]["count"] == 5
    rows = list(shown._server._rows)
    assert [row[0] for row in rows] == pytest.approx([0, 0.02, 0.04, 0.06, 0.08])
    assert rows[0][1:4] == [1, 2, 3]
    simulation.reset(0)
    with pytest.raises(qc.InputError, match="the time went back"):
        shown.sync()
    assert f'src="{shown.url}"' in shown._repr_html_()
    shown.close()


def test_a_view_begins_with_the_camera_that_is_given():
    simulation = qc.Simulation("quadrotor", engine="eigen")
    for shown in (simulation, flown()):
        seen = qc.view(shown, camera="top", browser=False)
        assert content_of(ask(seen._server).read().decode())["camera"] == "top"
        seen.close()
        with pytest.raises(qc.InputError, match="camera 'nose' is unknown"):
            qc.view(shown, camera="nose", browser=False)


def test_a_view_of_logs_is_a_page_in_notebooks_with_a_picture(tmp_path):
    shown = qc.view({"</script>a": flown(), "b": flown()}, browser=False)
    assert isinstance(shown, View) and shown.url in repr(shown)
    page = ask(shown._server).read().decode()
    assert [flight["name"] for flight in content_of(page)["flights"]] == ["</script>a", "b"]
    text = shown._repr_html_()
    assert 'srcdoc="' in text and "data:image/png;base64," in text
    shown.sync()
    shown.close()
    for wrong in (3, "log.csv", [1]):
        with pytest.raises(qc.InputError, match="shown: give a simulation, a log or logs"):
            qc.view(wrong, browser=False)
    with pytest.raises(qc.InputError, match="the log has 3 rotors"):
        qc.view(flown(), "quadrotor", browser=False)
    with pytest.raises(qc.InputError, match="Leave model out"):
        qc.view(qc.Simulation(), "quadrotor", browser=False)
    one = qc.view(flown(), browser=False)
    with pytest.raises(qc.InputError, match="Name a file that ends in"):
        one.save("a.txt")
    one.close()
