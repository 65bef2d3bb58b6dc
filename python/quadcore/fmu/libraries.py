"""The shared libraries inside an FMU: those that fly here, under names of their own."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path
from typing import Dict, List, Set

from .. import _core
from .._core import InputError
from ..simulation import Simulation

# The loader takes a library for one that it has loaded under the same name, so an FMU's would fly
# by another's core, or by this one's, whose folders may be gone.
_NAME = re.compile(rb"(?<=\0)[\w.+-]+\.so(?:\.\d+)*(?=\0)")
_EVERYWHERE = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|stdc\+\+|gcc_s))\.so.*")


class Libraries:
    """What an FMU needs beside the libraries of C and C++: the interface, core and plugins.

    Parameters
    ----------
    simulation
        Of the vehicle.

    Raises
    ------
    InputError
        A plugin is not one of quadcore's own, or the interface was not built.
    """

    def __init__(self, simulation: Simulation) -> None:
        own = Path(_core.plugin_folders()[-1])
        interface = own / "fmu" / "libquadcore_fmu.so"
        if not interface.is_file():
            raise InputError(
                f"{interface}: is missing: quadcore was built without QUADCORE_BUILD_FMU; build it "
                "anew"
            )
        self._interface = interface.read_bytes()
        self._plugins: Dict[str, bytes] = {}
        for plugin in simulation.plugins:
            path = Path(plugin.path)
            if path.parent not in (own, own / "quadcore"):
                raise InputError(
                    f"plugin '{plugin.name}': {plugin.filename} in {path.parent} is none of "
                    "quadcore's own, which alone are inside an FMU; leave it out with --ignore"
                )
            self._plugins[str(path.relative_to(own))] = path.read_bytes()
        self._linked: Dict[str, bytes] = {}
        loaded = [path for path in _loaded() if path.parent != own or "libquadcore" in path.name]
        to_see = [self._interface, *self._plugins.values()]
        while to_see:
            for name in _names(to_see.pop()) - set(self._linked):
                for path in loaded:
                    if f"{path.name}.".startswith(f"{name}."):  # links lead to longer names
                        self._linked[name] = path.read_bytes()
                        to_see.append(self._linked[name])

    def content(self) -> bytes:
        """Digest of all, by which an FMU is told from another."""
        digest = hashlib.sha256(self._interface)
        for _, data in sorted([*self._plugins.items(), *self._linked.items()]):
            digest.update(data)
        return digest.digest()

    def files(self, identifier: str, guid: str) -> Dict[str, bytes]:
        """Give each its place among the binaries; what others need is renamed by the GUID."""
        names = {}
        for name in self._linked:  # in place, so as long as before
            digest = hashlib.sha256(f"{guid}{name}".encode()).hexdigest()
            names[name] = f"{digest[: len(name) - 3]}.so"

        def renamed(data: bytes) -> bytes:
            for old, new in names.items():
                data = data.replace(b"\0%b\0" % old.encode(), b"\0%b\0" % new.encode())
            return data

        files = {f"{identifier}.so": renamed(self._interface)}
        for place, data in self._plugins.items():
            files[place] = renamed(data)
        for name, data in self._linked.items():
            files[names[name]] = renamed(data)
        return files


def _names(data: bytes) -> Set[str]:
    """Find the names in a library that may be those of others."""
    names = {name.decode() for name in _NAME.findall(data)}
    return {name for name in names if not _EVERYWHERE.fullmatch(name)}


def _loaded() -> List[Path]:
    """Find the libraries that this process has loaded."""
    maps = Path("/proc/self/maps").read_text(errors="surrogateescape").splitlines()
    return sorted({Path(line[line.index("/") :]) for line in maps if ".so" in line})
