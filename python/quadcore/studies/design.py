"""Designs: sets of points of the axes that a study simulates."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

from .._core import InputError
from ..support.input_files import read_text
from . import distributions
from .axes import Axis, make_axes, parse_axis

LARGEST = 1_000_000
"""Maximum number of samples, and of rows of a sweep."""

_LARGEST = 10**8  # maximum size of a file of points, bytes

Point = Dict[str, str]


class Block(NamedTuple):
    """Axes that vary together: each row contains their values at one point."""

    names: Sequence[str]
    rows: Sequence[Sequence[str]]
    is_drawn: bool = False


class Design(Sequence[Point]):
    """All combinations of the points of several blocks, where the last block varies fastest.

    Parameters
    ----------
    vary
        Values by name of the axis: a list, a text as for ``--vary``, or a distribution with a
        method ``ppf``. Names joined by commas share the same values.
    points
        CSV file with a header of axis names and one point per row.
    design, samples, seed
        See `distributions.draw_points`.

    Raises
    ------
    InputError
        If an axis has no values, or a name occurs in two axes.
    """

    def __init__(
        self,
        vary: Mapping[str, Any],
        points: Optional[Union[str, Path]] = None,
        design: str = "latin",
        samples: Optional[int] = None,
        seed: int = 0,
    ) -> None:
        listed: Dict[str, Any] = {}
        self.drawn: Dict[str, Any] = {}
        """Distribution of each randomly sampled axis."""
        for name, given in vary.items():
            made = distributions.parse(name, given) if isinstance(given, str) else given
            if hasattr(made, "ppf"):
                self.drawn[name] = made
            else:
                listed[name] = parse_axis(name, given).values if isinstance(given, str) else given
        self.kind, self.samples = design, samples
        self.listed = make_axes(listed)
        """Axes with lists of values."""
        blocks = [Block([axis.name], _Column(axis)) for axis in self.listed]
        if points is not None:
            blocks.append(_read_table(Path(points)))
        if self.drawn:
            names = list(self.drawn)
            if samples is None:
                raise InputError(
                    f"vary {names[0]}: a distribution requires a number of samples. Add --samples."
                )
            if samples > LARGEST:
                raise InputError(f"samples is {samples}. Give at most {LARGEST}.")
            values = list(self.drawn.values())
            rows = distributions.draw_points(names, values, design, samples, seed)
            blocks.append(Block(names, rows, is_drawn=True))
        elif samples is not None:
            raise InputError(
                f"samples is {samples} but no axis has a distribution. Vary one as "
                f"{', '.join(list_forms())}."
            )
        self.blocks = blocks
        self._sizes = [len(block.rows) for block in blocks]
        self._check_names()

    @property
    def names(self) -> List[str]:
        """Names of all axes, in the order of the blocks."""
        return [name for block in self.blocks for name in block.names]

    @property
    def size(self) -> int:
        """Number of points, which may exceed the limit of `len`."""
        return math.prod(self._sizes)

    def __len__(self) -> int:
        return self.size

    def __getitem__(self, i: Any) -> Any:
        if not 0 <= i < self.size:
            raise IndexError(i)
        where = []
        for size in reversed(self._sizes):
            i, at = divmod(i, size)
            where.append(at)
        return {
            name: value
            for block, at in zip(self.blocks, reversed(where))
            for name, value in zip(block.names, block.rows[at])
        }

    def values(self, name: str) -> Iterator[str]:
        """Yield the values of an axis, possibly repeated; nothing if the axis does not exist."""
        for block in self.blocks:
            if name in block.names:
                column = list(block.names).index(name)
                yield from (row[column] for row in block.rows)

    def pick_trial_points(self) -> List[Point]:
        """Return points that cover all values of each block, or the extremes of a long block."""
        if not len(self):
            return []
        first: Point = self[0]
        chosen = [first]
        for block in self.blocks:
            for at in _end_rows(block) if len(block.rows) > _FEW else range(len(block.rows)):
                chosen.append({**first, **dict(zip(block.names, block.rows[at]))})
        return list({tuple(point.items()): point for point in chosen}.values())

    def describe(self) -> Dict[str, Any]:
        """Return the number of values of each axis and the sampling settings, as plain values."""
        return {
            "axes": {name: len(set(self.values(name))) for name in self.names},
            "design": self.kind if self.drawn else None,
            "samples": self.samples,
        }

    def _check_names(self) -> None:
        taken: List[str] = []
        for name in self.names:
            for part in name.split(","):
                if part in taken:
                    raise InputError(f"vary {name}: {part} is varied twice. Remove one axis.")
                taken.append(part)


_FEW = 16  # maximum number of rows of a block that are all checked before the first flight


class _Column(Sequence[Tuple[str]]):
    """Values of one axis as rows."""

    def __init__(self, axis: Axis) -> None:
        self._values = axis.values

    def __len__(self) -> int:
        return len(self._values)

    def __getitem__(self, i: Any) -> Any:
        return (self._values[i],)


def list_forms() -> List[str]:
    """List the formats of the distributions."""
    return distributions.list_forms()


def _end_rows(block: Block) -> List[int]:
    """Return the first and last row, and those with the extremes of each numeric column."""
    found = [0, len(block.rows) - 1]
    for column in range(len(block.names)):
        try:
            numbers = [float(row[column]) for row in block.rows]
        except ValueError:
            continue
        found += [numbers.index(min(numbers)), numbers.index(max(numbers))]
    return sorted(set(found))


def _read_table(path: Path) -> Block:
    header, *lines = read_text(path, _LARGEST).rstrip().splitlines() or [""]
    names = [name.strip() for name in header.split(",")]
    if not all(names):
        raise InputError(f"{path}:1: the header is '{header[:80]}'. Name an axis in each column.")
    rows = []
    for number, line in enumerate(lines, start=2):
        cells = [cell.strip() for cell in line.split(",")]
        if len(cells) != len(names) or not all(cells):
            raise InputError(
                f"{path}:{number}: cells are missing or extra. Write {len(names)} values."
            )
        rows.append(cells)
    if not rows:
        raise InputError(f"{path}: the file contains no points. Write a row for each.")
    return Block(names, rows)
