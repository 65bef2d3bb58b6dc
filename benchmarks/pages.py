"""Pages of flights of 30 s: time to build, size, time to the first frame, frames per second, GIF.

The first frame and the frames per second are those of Chromium without a window and without a
graphics card, at 1280 px: each frame is drawn by the processor.
"""

import http.server
import json
import os
import platform
import queue
import shutil
import signal
import subprocess
import tempfile
import threading
import time
import urllib.parse

import quadcore as qc
from quadcore.model.visuals import read_vehicle
from quadcore.report.gif import find_browser, make_gif
from quadcore.report.player import PlayerFlight, make_page

DURATION = 30.0  # s
FLIGHTS = (2, 12)
DRAWN = 3.0  # s, of the frames that are counted
LONGEST = 300.0  # s, for the browser
COUNT = f"""<script>
addEventListener("load", async () => {{
  while (!window.quadcore) await new Promise((resolve) => setTimeout(resolve, 5));
  await quadcore.ready;
  const player = quadcore.players[0], {{ scene }} = player;
  scene.render();
  const result = {{ first: performance.now() / 1000 }}, begin = performance.now();
  let frames = 0;
  while (performance.now() - begin < {1000 * DRAWN}) {{
    player.go(player.end * (performance.now() - begin) / {1000 * DRAWN});
    scene.render();
    scene.renderer.getContext().finish();
    ++frames;
  }}
  result.rate = frames / ((performance.now() - begin) / 1000);
  fetch("/result?" + encodeURIComponent(JSON.stringify(result)));
}});
</script>"""


def simulate(count):
    """Simulate flights along circles of different sizes, as `quadcore play` reads them."""
    flights = []
    for number in range(count):
        circle = qc.references.circle(radius=1 + 0.2 * number)
        sim = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
        sim.set_state(qc.references.start(sim, circle))
        log = sim.run(DURATION, controller="geometric", reference=circle, log_every=10)
        flights.append(PlayerFlight(f"flight {number}", log, read_vehicle(sim.model)))
    return flights


class Handler(http.server.BaseHTTPRequestHandler):
    """Serves the page, and takes what its script measures."""

    def do_GET(self):
        name, _, query = self.path.partition("?")
        if name == "/result":
            self.server.results.put(json.loads(urllib.parse.unquote(query)))
        body = self.server.page if name == "/" else b""
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_):
        """Print nothing."""


def measure_frames(page):
    """Return the time to the first frame (s) and the frames per second in a browser."""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.page = page.replace("<head>", "<head>" + COUNT, 1).encode()
    server.results = queue.Queue()
    threading.Thread(target=server.serve_forever, daemon=True).start()
    folder = tempfile.mkdtemp()
    browser = subprocess.Popen(
        [find_browser(), "--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-port=0",
         "--enable-unsafe-swiftshader", "--window-size=1280,900", f"--user-data-dir={folder}",
         f"http://127.0.0.1:{server.server_port}/"],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
    )  # fmt: skip
    try:
        found = server.results.get(timeout=LONGEST)
    finally:
        os.killpg(browser.pid, signal.SIGKILL)
        browser.wait()
        server.shutdown()
        shutil.rmtree(folder, ignore_errors=True)
    return found["first"], found["rate"]


def main():
    print(f"machine: {platform.node()}, {platform.machine()}")
    pages = {}
    for count in FLIGHTS:
        flights = simulate(count)
        start = time.perf_counter()
        pages[count] = make_page(flights)
        seconds = time.perf_counter() - start
        print(f"page of {count} flights: {seconds:.2f} s, {len(pages[count]) / 1e6:.2f} MB")
        first, rate = measure_frames(pages[count])
        print(f"    first frame after {first:.2f} s, {rate:.0f} frames per second")
    start = time.perf_counter()
    size = len(make_gif(pages[FLIGHTS[0]]))
    print(f"GIF of {FLIGHTS[0]} flights: {time.perf_counter() - start:.1f} s, {size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
