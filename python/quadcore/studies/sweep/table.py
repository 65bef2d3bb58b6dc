"""Columns of a sweep in memory or in a Parquet file."""

from __future__ import annotations

import array
import sys
from pathlib import Path
from typing import Any, Dict, Iterator, List

import numpy as np

from ..._core import parse_number
from ...support.output_files import atomic_write
from .row_file import RowFile

_TEXTS = ("failure", "fingerprint")
_MANY = 10_000  # maximum number of rows in memory


def make_table(rows: RowFile) -> Dict[str, np.ndarray]:
    """Return all rows by column; a column is numeric if all its values are numbers."""
    texts = _text_columns(rows)
    columns: Dict[str, Any] = {
        name: [] if name in texts else array.array("Q" if name in rows.whole else "d")
        for name in rows.columns
    }
    for row in rows.read():
        for name, value in row.items():
            columns[name].append(_convert(value, name in texts, name in rows.whole))
    return {name: np.array(values) for name, values in columns.items()}


def write_parquet(rows: RowFile, path: Path) -> None:
    """Write the rows to a Parquet file.

    Raises
    ------
    InputError
        If pyarrow is missing or the file cannot be written.
    """
    from ...support.optional_packages import require_package

    with require_package("Parquet", "pyarrow", "sweep"):
        import pyarrow as arrow
        from pyarrow import parquet

    texts = _text_columns(rows)
    kinds = {name: arrow.float64() for name in rows.columns}
    kinds.update(dict.fromkeys(texts, arrow.string()))
    kinds.update((name, arrow.uint64()) for name in rows.whole)
    schema = arrow.schema(list(kinds.items()))
    with atomic_write(path) as stream, parquet.ParquetWriter(stream, schema) as writer:
        for several in _split_rows(rows.read()):
            arrays = []
            for name, kind in kinds.items():
                made = [_convert(row[name], name in texts, name in rows.whole) for row in several]
                arrays.append(arrow.array(made, kind))
            writer.write_table(arrow.Table.from_arrays(arrays, schema=schema))


def _text_columns(rows: RowFile) -> List[str]:
    """List the columns that contain text."""
    found = list(_TEXTS)
    for row in rows.read():
        found += [
            name
            for name, value in row.items()
            if name not in found and value and parse_number(value) is None and not _is_inf(value)
        ]
    return found


def _split_rows(rows: Iterator[Dict[str, str]]) -> Iterator[List[Dict[str, str]]]:
    piece: List[Dict[str, str]] = []
    for row in rows:
        piece.append(row)
        if len(piece) == _MANY:
            yield piece
            piece = []
    if piece:
        yield piece


def _convert(text: str, is_text: bool, is_whole: bool) -> Any:
    if is_text:
        return sys.intern(text)
    return int(text) if is_whole else _parse_float(text)


def _parse_float(text: str) -> float:
    return float(text) if text else float("nan")


def _is_inf(text: str) -> bool:
    return text in ("inf", "-inf")
