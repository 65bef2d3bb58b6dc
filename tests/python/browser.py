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
const told = {};
async function look(name, url, width) {
  const frame = document.createElement("iframe");
  frame.style.cssText = `width: ${width}px; height: 800px; border: 0`;
  frame.src = url;
  const loaded = new Promise((resolve) => (frame.onload = resolve));
  document.body.append(frame);
  await loaded;
  const view = frame.contentWindow, inside = frame.contentDocument, out = [];
  if (view.MathJax) await view.MathJax.startup.promise;
  const scrolls = (e) => view.getComputedStyle(e).overflowX !== "visible";
  const hidden = (e) => e && (scrolls(e) || hidden(e.parentElement));
  const what = (e) => e.tagName + ": " + e.textContent.trim().slice(0, 60);
  // The menu of a site waits beyond the edge.
  const all = [...(inside.querySelector("article") || inside.body).querySelectorAll("*")];
  for (const e of all) {
    const { left, right } = e.getBoundingClientRect();
    if ((left < -1 || right > width + 1) && !hidden(e.parentElement)) out.push(what(e));
    if (e.tagName === "IFRAME"
        && e.contentDocument.documentElement.scrollHeight > e.clientHeight + 1) {
      out.push(`a page within is cut, ${e.contentDocument.documentElement.scrollHeight} px`);
    }
    if (width > 600 && (e.tagName === "TABLE" || e.classList.contains("math-wrapper"))) {
      for (let at = e; at; at = at.parentElement) {
        if (at.scrollWidth > at.clientWidth + 1 && scrolls(at)) out.push("cut: " + what(e));
      }
    }
  }
  if (inside.documentElement.scrollWidth > width) out.push("scrolls sideways");
  told[`${name} ${width}`] = out;
  frame.remove();
}
window.onload = async () => {
  for (const [name, url, width] of PAGES) await look(name, url, width);
  const told_in = document.createElement("pre");
  told_in.id = "told";
  told_in.textContent = JSON.stringify({told, faults: window.faults});
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


def what_sticks_out(files, widths, folder):
    """Open files at some widths (px): what reaches beyond an edge, by (file, width).

    Where there is room, no table and no formula may have to be scrolled either, and nowhere a
    page within a page.
    """
    looked_at = [(str(file), file.as_uri(), width) for file in files for width in widths]
    script = STICK_OUT.replace("PAGES", json.dumps(looked_at))
    whole = f"<html><head>{CATCH}<script>{script}</script></head><body></body></html>"
    # As much time as the pages want; none passes while nothing happens.
    options = "--allow-file-access-from-files", "--virtual-time-budget=1000000"
    found = opened(whole, folder, *options)
    return {(name, width): found[f"{name} {width}"] for name, _, width in looked_at}


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
