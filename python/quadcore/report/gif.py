"""GIF of an animation, which a browser without a window draws."""

from __future__ import annotations

import base64
import contextlib
import os
import re
import shutil
import signal
import subprocess
import tempfile
from pathlib import Path
from typing import Sequence

from .._core import InputError

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
"""Commands that are tried, in this order."""

_LONGEST = 600.0  # s


def make_gif(page: str) -> bytes:
    """Draw the first animation of a page as a GIF of 560 x 360 px.

    Parameters
    ----------
    page
        Page from `make_page`; the GIF has its camera.

    Raises
    ------
    InputError
        If there is no browser, or it fails.
    """
    program = find_browser()
    folder = Path(tempfile.mkdtemp())
    try:
        file = folder / "page.html"
        file.write_text(page, encoding="utf-8")
        answer = _run(
            [
                *[program, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"],
                *["--enable-unsafe-swiftshader", f"--user-data-dir={folder}/user"],
                *["--virtual-time-budget=600000", "--dump-dom", f"{file.as_uri()}#gif"],
            ]
        )
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    found = re.search(rb'<pre id="gif">([A-Za-z0-9+/=]+)</pre>', answer)
    if found is None:
        raise InputError(
            f"{program}: has drawn no GIF. Open the page (-o PAGE.html), and press 'Save GIF'."
        )
    return base64.b64decode(found.group(1))


def find_browser() -> str:
    """Return the path of a browser; raises `InputError` without one."""
    program = next(filter(None, map(shutil.which, BROWSERS)), None)
    if program is None:
        raise InputError(
            "a GIF needs Chromium or Chrome. Install one (Debian, Ubuntu: apt install chromium), "
            "or press 'Save GIF' in the page."
        )
    return program


def _run(command: Sequence[str]) -> bytes:
    """Run a browser and return what it prints; none of its processes remains."""
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True
    )
    try:
        return process.communicate(timeout=_LONGEST)[0]
    except subprocess.TimeoutExpired:
        raise InputError(
            f"{command[0]}: has not drawn the GIF within {_LONGEST:g} s. Give a shorter flight."
        ) from None
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
