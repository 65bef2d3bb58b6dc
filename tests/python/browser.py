"""What pages do and how they look in a browser."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from chromium import FONTS, start_browser

CATCH = """<script>
window.faults = [];
window.onerror = (what) => faults.push(what);
window.addEventListener("unhandledrejection", (event) => faults.push(String(event.reason)));
for (const name of ["log", "info", "warn", "error", "debug"])
  console[name] = (...what) => faults.push(`console.${name}: ${what.join(" ")}`);
</script>"""
AXE = Path(__file__).resolve().parents[2] / "web/node_modules/axe-core/axe.min.js"
WHEN_READY = """<script>
window.addEventListener("load", async () => {
  const result = {};
  try {
    while (document.querySelector(".quadcore-player") && !window.quadcore)
      await new Promise((resolve) => setTimeout(resolve, 10));
    if (window.quadcore) await quadcore.ready;
    await (async () => { SCRIPT })();
  } catch (fault) {
    window.faults.push(String(fault.stack || fault));
  }
  answer(JSON.stringify({result, faults: window.faults}));
});
</script>"""


IN_FRAMES = """
const result = {};
async function opened(url, width) {
  const frame = document.createElement("iframe");
  frame.style.cssText = `width: ${width}px; height: 800px; border: 0`;
  frame.src = url;
  const loaded = new Promise((resolve) => (frame.onload = resolve));
  document.body.append(frame);
  await loaded;
  const { contentWindow: view, contentDocument: inside } = frame;
  if (view.MathJax) await view.MathJax.startup.promise;
  while (inside.querySelector(".quadcore-player") && !view.quadcore)
    await new Promise((resolve) => setTimeout(resolve, 10));
  if (view.quadcore) await view.quadcore.ready;
  return frame;
}
async function nextFrame(view) {
  for (let i = 0; i < 2; ++i) await new Promise((resolve) => view.requestAnimationFrame(resolve));
}
window.onload = async () => {
  try {
    for (const [name, url, widths] of PAGES) {
      const frame = await opened(url, widths[0]);
      for (const width of widths) {
        frame.style.width = `${width}px`;
        if (width != widths[0]) await nextFrame(frame.contentWindow);
        result[`${name} ${width}`] = await look(frame.contentWindow, frame.contentDocument, width);
      }
      frame.remove();
    }
  } catch (fault) {
    window.faults.push(String(fault));
  }
  answer(JSON.stringify({result, faults: window.faults}));
};
"""

STICK_OUT = """
function look(view, inside, width) {
  const out = [];
  const scrolls = (e) => view.getComputedStyle(e).overflowX !== "visible";
  const hidden = (e) => e && (scrolls(e) || hidden(e.parentElement));
  const what = (e) => e.tagName + ": " + e.textContent.trim().slice(0, 60);
  // The menu of a site waits beyond the edge.
  for (const e of (inside.querySelector("article") || inside.body).querySelectorAll("*")) {
    const { left, right } = e.getBoundingClientRect();
    if ((left < -1 || right > width + 1) && !hidden(e.parentElement)) out.push(what(e));
    if (e.tagName === "IFRAME") {
      const { scrollHeight } = e.contentDocument.documentElement;
      if (scrollHeight > e.clientHeight + 1) out.push(`a page within is ${scrollHeight} px high`);
    }
    if (width > 600 && (e.tagName === "TABLE" || e.classList.contains("math-wrapper"))) {
      for (let at = e; at; at = at.parentElement) {
        if (at.scrollWidth > at.clientWidth + 1 && scrolls(at)) out.push("cut: " + what(e));
      }
    }
  }
  if (inside.documentElement.scrollWidth > width) out.push("scrolls sideways");
  return out;
}
"""

AUDIT = """
async function look(view, inside) {
  for (const fold of inside.querySelectorAll("details")) fold.open = true;
  await nextFrame(view);
  const seen = { exclude: [[".plot > svg > g"]] };  // drawings have names
  const dark = view.matchMedia("(prefers-color-scheme: dark)").matches;
  // Dark pages differ in colours alone.
  const rules = dark ? { runOnly: ["color-contrast", "link-in-text-block"] } : {};
  const { violations } = await view.axe.run(seen, { resultTypes: ["violations"], ...rules });
  return {
    dark,
    violations: violations
      .filter(({ impact }) => ["serious", "critical"].includes(impact))
      .map(({ id, nodes }) => `${id}: ${nodes[0].html} ${nodes[0].failureSummary}`),
    faults: view.faults,
    requests: view.performance.getEntriesByType("resource").map(({ name }) => name.slice(0, 99)),
    images: inside.images.length,
    text: inside.body.innerText,
  };
}
"""

PLAY = """
async function look(view, inside) {
  const within = inside.querySelector("iframe");
  if (within) {
    within.scrollIntoView();
    [view, inside] = [within.contentWindow, within.contentDocument];
  }
  while (!view.quadcore) await new Promise((resolve) => setTimeout(resolve, 10));
  await view.quadcore.ready;
  let now = 0, waiting = [];  // for frames of a screen that there is not: 5 in a second
  const pass = () => { now += 200; for (const draw of waiting.splice(0)) draw(now); };
  view.requestAnimationFrame = (draw) => {
    if (!waiting.length) view.setTimeout(pass, 0);
    return waiting.push(draw);
  };
  const part = (name) => inside.querySelector(".quadcore-player " + name), canvas = part("canvas");
  const { scene } = view.quadcore.players[0];
  const time = () => Number(part(".time").value);
  const until = async (met) => {
    for (let i = 0; !met(); ++i) {
      if (i > 2000) throw "it does not come so far";
      await new Promise((resolve) => view.requestAnimationFrame(resolve));
    }
  };
  const drawn = () => { scene.render(); return canvas.toDataURL(); };
  const result = { start: drawn(), begin: time() };
  part(".speed").value = "4";
  part(".play").click();
  result.says = part(".play").textContent;
  await until(() => time() > 0.5);
  result.flying = drawn();
  canvas.dispatchEvent(new view.KeyboardEvent("keydown", { key: " ", bubbles: true }));
  result.held = [part(".play").textContent, time()];
  for (let i = 0; i < 5; ++i) await new Promise((resolve) => view.requestAnimationFrame(resolve));
  result.still = [part(".play").textContent, time()];
  part(".play").click();
  await until(() => part(".play").textContent === "Play");
  Object.assign(result, { end: drawn(), ended: time(), clock: part(".clock").textContent });
  part(".play").click();
  await until(() => time() > 0.1 && time() < result.ended / 2);
  result.again = part(".play").textContent;
  return result;
}
"""


def run_script(page, script, folder):
    """Open a page, run a script that fills the object `result`, and give that.

    A fault of the page's own scripts, or of this one, fails the test.
    """
    tell = f"""<script>
    window.addEventListener("load", () => answer(JSON.stringify({{result, faults}})));
    const result = {{}};
    {script}
    </script>"""
    return open_page(
        page.replace("<head>", "<head>" + CATCH).replace("</body>", tell + "</body>"), folder
    )


def run_script_when_ready(page, script, folder, dark=False):
    """As `run_script`, once the players of the page have started; the script may wait for promises.

    Lines in the console count as faults.
    """
    tell = CATCH + WHEN_READY.replace("SCRIPT", script)
    return open_page(page.replace("<head>", "<head>" + tell), folder, dark, scale=0.5)


def find_violations(page, folder, dark=False):
    """What axe-core finds serious or critical in a page: rule and element of each."""
    if not AXE.exists():
        pytest.skip("needs axe-core; scripts/bundle_player installs it")
    script = """
    const { violations } = await axe.run(document, { resultTypes: ["violations"] });
    result.dark = matchMedia("(prefers-color-scheme: dark)").matches;
    result.found = violations.filter(({ impact }) => ["serious", "critical"].includes(impact)).map(
      ({ id, nodes }) => `${id}: ${nodes[0].html} ${nodes[0].failureSummary}`);
    """
    axe = f"<head><script>{AXE.read_text(encoding='utf-8')}</script>"
    found = run_script_when_ready(page.replace("<head>", axe, 1), script, folder, dark)
    assert found["dark"] == dark
    return found["found"]


def look_at_pages(look, files, widths, folder, fonts="wide", dark=False, once=False, scale=1.0):
    """Open files at some widths (px): what a script finds in each, by (file, width).

    Opened once, a file is resized from width to width.
    """
    openings = [widths] if once else [[width] for width in widths]
    pages = [(str(file), file.as_uri(), opening) for file in files for opening in openings]
    script = f"const PAGES = {json.dumps(pages)};{IN_FRAMES}{look}"
    whole = f"<html><head>{CATCH}<script>{script}</script></head><body></body></html>"
    found = open_page(whole, folder, dark, fonts, scale)
    return {
        (name, width): found[f"{name} {width}"] for name, _, opening in pages for width in opening
    }


def what_sticks_out(files, widths, folder, once=False):
    """What reaches beyond an edge of a page, by (file, width, fonts).

    Where there is room, no table and no formula may have to be scrolled either, and nowhere a
    page within a page.
    """
    return {
        (*page, fonts): out
        for fonts in FONTS
        for page, out in look_at_pages(STICK_OUT, files, widths, folder, fonts, once=once).items()
    }


def audit_pages(files, folder, dark=False):
    """What is wrong with pages that are open with all their folds, by file.

    These are lines in the console and faults, requests, images, and what axe-core finds serious
    or critical.
    """
    if not AXE.exists():
        pytest.skip("needs axe-core; scripts/bundle_player installs it")
    head = f"<head>{CATCH}<script>{AXE.read_text(encoding='utf-8')}</script>"
    copies = {}
    for number, file in enumerate(files):
        copy = folder / f"audited_{number}.html"
        copy.write_text(file.read_text(encoding="utf-8").replace("<head>", head, 1))
        copies[str(copy)] = file
    found = look_at_pages(AUDIT, map(Path, copies), [1280], folder, dark=dark, scale=0.5)
    assert all(each.pop("dark") == dark for each in found.values())
    return {copies[name]: each for (name, _), each in found.items()}


def assert_it_plays(file, widths, folder):
    """The player in a page, or in the page within that, flies from the beginning to the end."""
    for found in look_at_pages(PLAY, [file], widths, folder, scale=0.5).values():
        assert len({found["start"], found["flying"], found["end"]}) == 3
        assert found["begin"] == 0 and found["says"] == found["again"] == "Pause"
        assert found["held"] == found["still"] and found["held"][0] == "Play"
        assert found["clock"] == "{0:.2f} of {0:.2f} s".format(found["ended"])


def open_page(page, folder, dark=False, fonts="wide", scale=1.0):
    """What a page gives to its function `answer`: an object `result`, and faults."""
    file = folder / "opened.html"
    file.write_text(page, encoding="utf-8")
    content = json.loads(start_browser(fonts).open(file.as_uri(), dark, scale))
    assert content["faults"] == []
    return content["result"]
