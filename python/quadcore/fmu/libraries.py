"""Shared libraries of an FMU, with unique names."""

from __future__ import annotations

import hashlib
import re
import struct
from pathlib import Path
from typing import Dict, List, Set

from .. import _core
from .._core import InputError
from ..simulation.simulation import Simulation

# The loader reuses a loaded library with the same name. Unique names prevent an FMU from using the
# core of another FMU or of this process.
_PT_LOAD, _PT_DYNAMIC, _DT_NEEDED, _DT_STRTAB = 1, 2, 1, 5
_EVERYWHERE = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|stdc\+\+|gcc_s))\.so.*")


class Libraries:
    """Libraries of an FMU, except for those of C and C++: interface, core and plugins.

    Parameters
    ----------
    simulation
        Simulation of the vehicle.

    Raises
    ------
    InputError
        If a plugin is not part of quadcore, or the interface was not built.
    """

    def __init__(self, simulation: Simulation) -> None:
        own = Path(_core.plugin_folders()[-1])
        interface = own / "fmu" / "libquadcore_fmu.so"
        if not interface.is_file():
            raise InputError(
                f"{interface}: the file is missing, as quadcore was built without "
                "QUADCORE_BUILD_FMU. Build it with this option."
            )
        self._interface = interface.read_bytes()
        self._plugins: Dict[str, bytes] = {}
        for plugin in simulation.plugins:
            path = Path(plugin.path)
            if path.parent not in (own, own / "quadcore"):
                raise InputError(
                    f"plugin '{plugin.name}': {plugin.filename} in {path.parent} is not part of "
                    "quadcore, and an FMU cannot contain it. Remove it with --ignore."
                )
            self._plugins[str(path.relative_to(own))] = path.read_bytes()
        self._linked: Dict[str, bytes] = {}
        loaded = _list_loaded()
        to_see = [self._interface, *self._plugins.values()]
        while to_see:
            for name in _read_needed(to_see.pop()) - set(self._linked):
                for path in loaded:
                    if f"{path.name}.".startswith(
                        f"{name}."
                    ):  # a symbolic link points to a longer name
                        self._linked[name] = path.read_bytes()
                        to_see.append(self._linked[name])

    def compute_digest(self) -> bytes:
        """Return a digest of all libraries."""
        digest = hashlib.sha256(self._interface)
        for _, data in sorted([*self._plugins.items(), *self._linked.items()]):
            digest.update(data)
        return digest.digest()

    def make_files(self, identifier: str, guid: str) -> Dict[str, bytes]:
        """Return the libraries by their path in the FMU, with names derived from the GUID."""
        names = {}
        for name in self._linked:  # same length, because names are replaced in place
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


def _read_needed(data: bytes) -> Set[str]:
    """List the libraries that a 64-bit ELF file needs (man 5 elf)."""
    (headers,) = struct.unpack_from("<Q", data, 32)
    size, count = struct.unpack_from("<HH", data, 54)
    # Type, flags, offset, address, physical address, size.
    segments = [struct.unpack_from("<IIQQQQ", data, headers + i * size) for i in range(count)]
    dynamic = next(segment for segment in segments if segment[0] == _PT_DYNAMIC)
    entries = list(struct.iter_unpack("<QQ", data[dynamic[2] : dynamic[2] + dynamic[5] // 16 * 16]))
    address = dict(entries)[_DT_STRTAB]
    texts = next(
        address - segment[3] + segment[2]
        for segment in segments
        if segment[0] == _PT_LOAD and segment[3] <= address < segment[3] + segment[5]
    )
    starts = [texts + value for tag, value in entries if tag == _DT_NEEDED]
    names = {data[start : data.index(b"\0", start)].decode() for start in starts}
    return {name for name in names if not _EVERYWHERE.fullmatch(name)}


def _list_loaded() -> List[Path]:
    """List the libraries that this process has loaded."""
    maps = Path("/proc/self/maps").read_text(errors="surrogateescape").splitlines()
    return sorted({Path(line[line.index("/") :]) for line in maps if ".so" in line})
