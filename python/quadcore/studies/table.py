"""Tables of studies and their files."""

from __future__ import annotations

import csv
import io
import json
import math
from pathlib import Path
from typing import Any, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple

from ..support.output_files import atomic_write, encode_text, escape_cell


def make_csv(rows: Iterable[Sequence[Any]]) -> bytes:
    """Convert rows to CSV; NaN becomes an empty cell."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    for row in rows:
        writer.writerow(["" if value != value else escape_cell(value) for value in row])
    return encode_text(stream.getvalue())


def make_json(content: Any) -> bytes:
    """Convert lists and dictionaries to JSON; NaN becomes null."""
    text = json.dumps(_plain(content), indent=1, ensure_ascii=False, allow_nan=False)
    return encode_text(text + "\n")


def format_number(value: float) -> str:
    """Format a number with four significant digits; NaN becomes ""."""
    return "" if math.isnan(value) else f"{value:.4g}"


def choose_display_unit(unit: str) -> Tuple[str, float]:
    """Return the display unit and the conversion factor; only radians change, to degrees."""
    return ("deg", 180 / math.pi) if unit == "rad" else (unit, 1.0)


NOT_FLOWN = "not flown: interrupted"
"""Failure of flights that did not run because of an interrupt."""


def count_outcomes(failures: Sequence[str]) -> str:
    """Return the numbers of successful, failed and missing flights in one line."""
    left_out = sum(1 for failure in failures if failure == NOT_FLOWN)
    failed = sum(1 for failure in failures if failure) - left_out
    flown = len(failures) - failed - left_out
    text = f"{len(failures)} flights: {flown} flown, {failed} failed"
    return text + (f", {left_out} not flown" if left_out else "")


def save_files(folder: Path, files: Mapping[str, bytes]) -> List[Path]:
    """Write each file atomically into a folder, and return the paths.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    for name, data in files.items():
        with atomic_write(folder / name) as stream:
            stream.write(data)
    return [folder / name for name in files]


def _plain(content: Any) -> Any:
    if isinstance(content, Mapping):
        return {key: _plain(value) for key, value in content.items()}
    if isinstance(content, (list, tuple)):
        return [_plain(value) for value in content]
    return None if content != content else content


_NAMED = 4  # maximum number of names of a kind in a line


def describe_conditions(settings: Mapping[str, Any]) -> str:
    """Describe the conditions of the flights of a study in one line, for the head of its page.

    Parameters
    ----------
    settings
        Settings of all flights. Only known settings are described.
    """
    parts = []
    for kinds in ("models", "engines", "controllers", "references", "scenarios"):
        names = [name for name in settings.get(kinds, ()) if name]
        if len(names) > _NAMED:
            parts.append(f"{len(names)} {kinds}")
        elif names:
            parts.append(f"{kinds if len(names) > 1 else kinds[:-1]} {', '.join(names)}")
    if "duration" in settings:
        parts.append(f"{settings['duration']:g} s at steps of {1e3 * settings['dt']:g} ms")
    seeds = settings.get("seeds", ())
    if len(seeds):
        parts.append(f"{len(seeds)} seeds" if len(seeds) > 1 else f"seed {seeds[0]}")
    text = "; ".join(parts)
    return f"{text[:1].upper()}{text[1:]}." if text else ""


def format_settings(setting: Mapping[str, Any], most: Optional[int] = None) -> Dict[str, str]:
    """Format settings for a page, without empty values; a list shows at most `most` entries."""
    found = {}
    for name, value in setting.items():
        if isinstance(value, Mapping):
            value = [f"{key}={one}" for key, one in value.items()]
        text = str(value)
        if isinstance(value, list):
            shown = value[:most]
            rest = f", ... ({len(value)})" if len(value) > len(shown) else ""
            text = ", ".join(map(str, shown)) + rest
        if text and value is not None:
            found[name] = text
    return found
