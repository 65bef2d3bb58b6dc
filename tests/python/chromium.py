"""A browser without a window. One process for each set of fonts opens the pages of all tests.

Requests and messages of the Chrome DevTools Protocol pass through two pipes:
https://chromedevtools.github.io/devtools-protocol/.
"""

from __future__ import annotations

import atexit
import functools
import json
import os
import select
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest

# Readers' browsers have narrow fonts or wide ones; scripts/test installs these.
FONTS = {  # proportional twice: sans-serif, system-ui; monospace
    "narrow": ("FreeSans", "FreeSans", "FreeMono"),
    "wide": ("DejaVu Sans", "DejaVu Sans", "DejaVu Sans Mono"),
}
NAMES = ("chromium", "chromium-browser", "google-chrome")
LONGEST = 600  # s, between two messages
# fmt: off
OPTIONS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe",
    "--allow-file-access-from-files", "--no-first-run", "--disable-extensions",
    "--disable-background-networking", "--disable-component-update",
)
# fmt: on


class Browser:
    """A process with one page, which can be at one address after the other."""

    def __init__(self, program, fonts):
        self.folder = tempfile.TemporaryDirectory()
        folder = Path(self.folder.name)
        for pipe in ("requests", "messages"):
            os.mkfifo(folder / pipe)
        self.process = subprocess.Popen(
            ["sh", "-c", 'exec "$@" 3<requests 4>messages', "sh", program, *OPTIONS,
             f"--user-data-dir={folder}/user", "about:blank"],
            env={**os.environ, "FONTCONFIG_FILE": str(choose_fonts(fonts, folder))},
            cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        self.requests = open(folder / "requests", "wb", buffering=0)  # noqa: SIM115
        self.messages = open(folder / "messages", "rb", buffering=0)  # noqa: SIM115
        self.received, self.number, self.page = b"", 0, {}
        target = self.call("Target.createTarget", url="about:blank")
        self.page = self.call("Target.attachToTarget", **target, flatten=True)  # its sessionId
        self.call("Runtime.enable")
        self.call("Runtime.addBinding", name="answer")

    def close(self):
        """End the process, which does so when its pipe ends."""
        self.requests.close()
        self.messages.close()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.folder.cleanup()

    def open(self, url, dark=False, scale=1.0):
        """Return what a page gives to its function `answer`.

        Parameters
        ----------
        url
            Address of the page, whose window has 1000 by 900 px.
        dark
            Whether its reader prefers dark pages.
        scale
            Pixels of the screen in a pixel of the page; a small one saves the time of drawing.
        """
        size = {"width": 1000, "height": 900, "deviceScaleFactor": scale, "mobile": False}
        theme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        try:
            self.call("Emulation.setDeviceMetricsOverride", **size)
            self.call("Emulation.setEmulatedMedia", features=[theme])
            self.send("Page.navigate", url=url)
            answer = self.receive(lambda message: message.get("method") == "Runtime.bindingCalled")
            self.call("Page.navigate", url="about:blank")  # else an animation would go on
        except BaseException:  # what the page still says is no matter of the next test
            self.process.kill()
            start_browser.cache_clear()
            raise
        return answer["params"]["payload"]

    def call(self, method, **parameters):
        """Return the result of a request."""
        self.send(method, **parameters)
        message = self.receive(lambda message: message.get("id") == self.number)
        return message["result"]

    def send(self, method, **parameters):
        self.number += 1
        request = {"id": self.number, "method": method, "params": parameters, **self.page}
        self.requests.write(json.dumps(request).encode() + b"\0")

    def receive(self, is_wanted):
        """Return the next message that is wanted, past others."""
        while True:
            while b"\0" not in self.received:
                assert select.select([self.messages], [], [], LONGEST)[0], (
                    "no message of the browser"
                )
                piece = self.messages.read(1 << 20)
                assert piece, "the browser has ended"
                self.received += piece
            text, _, self.received = self.received.partition(b"\0")
            message = json.loads(text)
            failed = message.get("error") or message.get("result", {}).get("errorText")
            assert not failed, failed
            assert message.get("method") != "Inspector.targetCrashed", "the page has crashed"
            assert message.get("method") != "Runtime.exceptionThrown", message["params"]
            if is_wanted(message):
                return message


@functools.lru_cache(maxsize=None)
def start_browser(fonts):
    """Return the browser with a set of fonts, which ends with this process."""
    program = next(filter(None, map(shutil.which, NAMES)), None)
    if program is None:
        pytest.skip(f"needs a browser, one of {', '.join(NAMES)}; scripts/test installs one")
    browser = Browser(program, fonts)
    atexit.register(browser.close)
    return browser


def choose_fonts(fonts, folder):
    """Write a configuration of fontconfig in which generic names stand for one set of fonts."""
    generic = zip(("sans-serif", "system-ui", "monospace"), FONTS[fonts])
    aliases = "".join(
        f"<alias><family>{name}</family><prefer><family>{font}</family></prefer></alias>"
        for name, font in generic
    )
    file = folder / f"{fonts}.conf"
    file.write_text(
        f"<fontconfig><dir>/usr/share/fonts</dir><cachedir>{folder}/{fonts}</cachedir>"
        f"{aliases}</fontconfig>"
    )
    return file
