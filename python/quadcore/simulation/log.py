"""What a flight leaves behind."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Dict, List, Mapping, Sequence, Tuple, Union

import numpy as np

from .._core import InputError
from ..formats import find_format, mat
from ..formats.rows import LogFile, list_wrench_columns, split_columns
from ..support.arguments import NAME, check
from ..support.import_lock import LOCK
from ..support.optional_packages import require_package
from ..support.output_files import check_writable
from ..support.parameters import suggest
from .trajectory import Trajectory

PathLike = Union[str, "os.PathLike[str]"]

_WRITTEN = "logs are written to"
_READ = "logs are read from"


class Log(Trajectory):
    """States of a flight, to be written and drawn; made as its base `Trajectory` is.

    ``log["x"]`` is a column (rows,) by the name that it has in the CSV file.
    """

    @classmethod
    def of_rows(
        cls,
        rows: np.ndarray,
        columns: Sequence[str],
        wrenches: Mapping[str, np.ndarray],
        ignored: Sequence[str] = (),
        title: str = "",
    ) -> Log:
        """Make a log of rows that hold topics as well.

        Parameters
        ----------
        rows : ndarray (rows, columns)
            A row per logged step.
        columns : sequence of str
            What they hold: the columns of the state, then ``TOPIC.FIELD``.
        wrenches, ignored, title
            As of `Trajectory`.
        """
        of_state, topics = split_columns(columns, rows)
        return cls(rows[:, : len(of_state)], wrenches, title, ignored, topics)

    @classmethod
    def of_file(cls, path: PathLike) -> Log:
        """Read a ``.csv``, ``.mat`` or ``.bag`` file that `to_file` wrote, every bit restored.

        Parameters
        ----------
        path : str or path
            The suffix says which.

        Raises
        ------
        InputError
            Another suffix, a file that cannot be read, or one that holds no log; the message begins
            with the file and, if it is text, the line.
        """
        file = _check_path(path)
        read = find_format(file, _READ).read_log(file)
        return cls.of_rows(read.rows, read.columns, read.wrenches, read.ignored)

    def to_dict(self) -> Dict[str, np.ndarray]:
        """Name every column as the CSV file does, topics and wrenches included; shape (rows,)."""
        named = dict(zip(self.columns, self.table.T))
        for topic, fields in self.topics.items():
            named.update((f"{topic}.{field}", column) for field, column in fields.items())
        for term, wrench in self.wrenches.items():
            named.update(zip(list_wrench_columns([term]), wrench.T))
        return named

    def to_dataframe(self) -> Any:
        """Make a pandas DataFrame of every column of `to_dict`, indexed by the time ``t`` [s].

        Raises
        ------
        InputError
            pandas is not installed.
        """
        with require_package("log.to_dataframe()", "pandas", "pandas"):
            import pandas
        return pandas.DataFrame(self.to_dict()).set_index("t")

    def __getitem__(self, column: str) -> np.ndarray:
        named = self.to_dict()
        if not isinstance(column, str) or column not in named:
            near = suggest(str(column), list(named))
            raise InputError(f"log[{column!r}]: no such column{near}; log.to_dict() has them all")
        return named[column]

    def __contains__(self, column: object) -> bool:
        return isinstance(column, str) and column in self.to_dict()

    def __iter__(self) -> Any:
        raise TypeError("a log is iterated by its arrays, log.time say, or log.to_dict()")

    def _ipython_key_completions_(self) -> list[str]:
        return list(self.to_dict())

    def __repr__(self) -> str:
        flown = f" of {self.title}" if self.title else ""
        span = f", t = {self.time[0]:g} to {self.time[-1]:g} s" if len(self) else ""
        more = "".join(
            f", {kind} {', '.join(names)}"
            for kind, names in (("topics", self.topics), ("wrenches", self.wrenches))
            if names
        )
        return f"<Log{flown}: {len(self)} rows{span}{more}>"

    def _repr_html_(self) -> str:
        from ..report.html_table import html_title  # these are slow to import

        if len(self) == 0:
            return html_title(self)
        with LOCK:
            from ..report.log_plots import draw_overview
            from ..report.page import embed_image
            from ..report.plots import png

        return html_title(self) + str(
            embed_image(png(draw_overview(self)), "position and attitude over time")
        )

    def to_csv(self, path: PathLike) -> None:
        """Write `table` as text with the fewest digits that restore every bit.

        Columns of topics follow, named ``TOPIC.FIELD``, and six of each wrench, ``wrench_NAME.fx``
        to ``wrench_NAME.tz``.
        What was `ignored`, if anything, stands in a comment below the names of the columns.

        Parameters
        ----------
        path : str or path
            A file that ends in ``.csv``.

        Raises
        ------
        InputError
            Another suffix, or a file that cannot be written; nothing is left behind then.
        """
        self._check_suffix(path, ".csv")
        self.to_file(path)

    def to_mat(self, path: PathLike, layout: str = "vectors") -> None:
        """Write a MATLAB file of each column as a vector and each wrench as ``wrench_NAME``.

        Each topic is a struct ``topic_NAME`` of a vector for each field.
        What was `ignored`, if anything, is the cell array ``ignored``.

        Parameters
        ----------
        path
            A file that ends in ``.mat``.
        layout
            "vectors"; or all that in the one variable ``log``: a "struct" of it, a "matrix" with
            the names of its ``columns`` beside it, or time and "signals", as Simulink has them.

        Raises
        ------
        InputError
            Another suffix or layout, or a file that cannot be written; nothing is left behind then.
        """
        self._check_suffix(path, ".mat")
        mat.write_log(_check_path(path), *self._parts(), layout)

    def to_file(self, path: PathLike) -> None:
        """Write a ``.csv``, ``.mat`` or ``.bag`` file.

        Parameters
        ----------
        path : str or path
            The suffix says which.

        Raises
        ------
        InputError
            Another suffix, or a file that cannot be written; nothing is left behind then.
        """
        file = _check_path(path)
        find_format(file, _WRITTEN).write_log(file, *self._parts())

    def _parts(self) -> Tuple[List[str], np.ndarray, Mapping[str, np.ndarray], List[str]]:
        """Give what files hold: columns, table, wrenches, and what was ignored."""
        columns, table = list(self.columns), self.table
        if self.topics:
            columns += [f"{topic}.{field}" for topic in self.topics for field in self.topics[topic]]
            of_topics = [column for fields in self.topics.values() for column in fields.values()]
            table = np.column_stack([table, *of_topics])
        return columns, table, self.wrenches, self.ignored

    def plot(self, directory: PathLike) -> list[Path]:
        """Draw the flight into PNG files.

        Parameters
        ----------
        directory : str or path
            Where to; it is made if it is missing.

        Returns
        -------
        list of Path
            The files.

        Raises
        ------
        InputError
            They cannot be written.
        """
        folder = _check_path(directory, "directory")
        with LOCK:
            from ..report.log_plots import draw  # matplotlib is slow to import

        return draw(self, folder)

    def _check_suffix(self, path: PathLike, suffix: str) -> None:
        if _check_path(path).suffix.lower() != suffix:
            raise InputError(f"{path}: name a file that ends in {suffix}, which it would hold")


def _check_path(path: PathLike, argument: str = "path") -> Path:
    check({argument: path}, {argument: NAME})
    return Path(path)


def check_log_path(path: PathLike) -> None:
    """Raise `InputError` now if `Log.to_file` could not write `path` later."""
    find_format(Path(path), _WRITTEN)
    check_writable(Path(path))


def make_log_file(
    path: Path, columns: Sequence[str], terms: Sequence[str], ignored: Sequence[str]
) -> LogFile:
    """Make the recorder that a file's name asks for.

    Parameters
    ----------
    path
        The file.
    columns
        Of the flight.
    terms
        Of the wrenches that are logged.
    ignored
        What was left out of model and world.
    """
    return find_format(path, _WRITTEN).log_file(path, columns, terms, ignored)
