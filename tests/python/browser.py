"""A browser without a window, to see what pages do."""

from __future__ import annotations

import html
import json
import re
import shutil
import subprocess

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome")
CATCH = "<script>window.faults = []; window.onerror = (what) => faults.push(what);</script>"


def told(page, script, folder):
    """Open a page, run a script that fills the object `told`, and give that.

    A fault of the page's own scripts, or of this one, fails the test.
    """
    program = next(filter(None, map(shutil.which, NAMES)), None)
    if program is None:
        pytest.skip(f"needs a browser, one of {', '.join(NAMES)}; scripts/test installs one")
    tell = (
        f"<script>const told = {{}};\n{script}\nconst told_in = document.createElement('pre');\n"
        "told_in.id = 'told'; told_in.textContent = JSON.stringify({told, faults});\n"
        "document.body.append(told_in);</script>"
    )
    file = folder / "opened.html"
    file.write_text(page.replace("<head>", "<head>" + CATCH).replace("</body>", tell + "</body>"))
    answer = subprocess.run(
        [program, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder}/user",
         "--window-size=1000,900", "--dump-dom", file.as_uri()],
        capture_output=True, check=True, timeout=300,
    )  # fmt: skip
    found = re.search(r'<pre id="told">(.*?)</pre>', answer.stdout.decode(), re.DOTALL)
    assert found, answer.stderr.decode()[-2000:]
    content = json.loads(html.unescape(found.group(1)))
    assert content["faults"] == []
    return content["told"]
