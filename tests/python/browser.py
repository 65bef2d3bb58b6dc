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


STICK_OUT = """
const told_of = {};
window.onload = () => {
  for (const frame of document.querySelectorAll("iframe")) {
    const inside = frame.contentDocument, width = frame.clientWidth, out = [];
    const hidden = (e) => e && (frame.contentWindow.getComputedStyle(e).overflowX !== "visible"
                                || hidden(e.parentElement));
    for (const e of inside.querySelectorAll("body *")) {
      if (e.getBoundingClientRect().right > width + 1 && !hidden(e.parentElement)) {
        out.push(e.tagName + ": " + e.textContent.slice(0, 40));
      }
    }
    for (const table of width < 600 ? [] : inside.querySelectorAll("table")) {
      if (table.scrollWidth > table.clientWidth) out.push("cut: " + table.textContent);
    }
    if (inside.documentElement.scrollWidth > width) out.push("scrolls sideways");
    told_of[frame.name] = out;
  }
  const told_in = document.createElement("pre");
  told_in.id = "told";
  told_in.textContent = JSON.stringify({told: told_of, faults: window.faults});
  document.body.append(told_in);
};
"""


def told(page, script, folder):
    """Open a page, run a script that fills the object `told`, and give that.

    A fault of the page's own scripts, or of this one, fails the test.
    """
    tell = (
        f"<script>const told = {{}};\n{script}\nconst told_in = document.createElement('pre');\n"
        "told_in.id = 'told'; told_in.textContent = JSON.stringify({told, faults});\n"
        "document.body.append(told_in);</script>"
    )
    return opened(
        page.replace("<head>", "<head>" + CATCH).replace("</body>", tell + "</body>"), folder
    )


def what_sticks_out(pages, widths, folder):
    """Open pages at some widths (px): what reaches beyond the right edge, by (name, width).

    Where there is room, no table may have to be scrolled either.
    """
    frames = "".join(
        f'<iframe name="{name} {width}" style="width: {width}px; height: 800px; border: 0" '
        f'srcdoc="{html.escape(page)}"></iframe>'
        for name, page in pages.items()
        for width in widths
    )
    whole = f"<html><head>{CATCH}<script>{STICK_OUT}</script></head><body>{frames}</body></html>"
    found = opened(whole, folder, "--virtual-time-budget=10000")
    return {(name, width): found[f"{name} {width}"] for name in pages for width in widths}


def opened(page, folder, *options):
    """What a page has written into its element #told."""
    program = next(filter(None, map(shutil.which, NAMES)), None)
    if program is None:
        pytest.skip(f"needs a browser, one of {', '.join(NAMES)}; scripts/test installs one")
    file = folder / "opened.html"
    file.write_text(page)
    answer = subprocess.run(
        [program, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder}/user",
         "--window-size=1000,900", *options, "--dump-dom", file.as_uri()],
        capture_output=True, check=True, timeout=300,
    )  # fmt: skip
    found = re.search(r'<pre id="told">(.*?)</pre>', answer.stdout.decode(), re.DOTALL)
    assert found, answer.stderr.decode()[-2000:]
    content = json.loads(html.unescape(found.group(1)))
    assert content["faults"] == []
    return content["told"]
