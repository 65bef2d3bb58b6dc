"""The public class `Log`."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Dict, List, Mapping, Sequence, Tuple, Union

import numpy as np

from .._core import InputError
from ..formats import find_format, mat
from ..formats.rows import LogFile, list_wrench_columns, split_columns
from ..report.drawing import check_formats, get_formats, name_files, use_formats
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
    """Logged states of a flight, with methods that write and plot them.

    ``log["x"]`` returns a column (rows,) by its name in the CSV file. The parameters are those of
    `Trajectory`.
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
        """Make a log from rows that also contain topics.

        Parameters
        ----------
        rows : ndarray (rows, columns)
            One row per logged step.
        columns : sequence of str
            Names of the columns: those of the state, then ``TOPIC.FIELD`` for topics.
        wrenches, ignored, title
            As for `Trajectory`.
        """
        of_state, topics = split_columns(columns, rows)
        return cls(rows[:, : len(of_state)], wrenches, title, ignored, topics)

    @classmethod
    def of_file(cls, path: PathLike, mapping: Union[PathLike, None] = None) -> Log:
        """Read a file written by `to_file`, bit-identically, or a recording of a real flight.

        Parameters
        ----------
        path : str or path
            ``.csv``, ``.mat`` or ``.bag`` file written by quadcore, or the folder of a ROS 2 bag.
            Recordings are a ULog, a Crazyflie micro-SD log, a blackbox log, or a CSV file or a bag
            with other columns. They may be compressed by gzip.
        mapping : str or path, optional
            Description of the columns of a recording: a YAML file or a built-in name. Default: the
            built-in mapping that matches.

        Raises
        ------
        InputError
            If the format is unknown, the file cannot be read, or it contains no log. The message
            begins with the file and, for text files, the line.
        """
        with LOCK:
            from ..formats.recordings import is_recording, make_log_rows, read_recording
        file = _check_path(path)
        if mapping is not None or is_recording(file):
            read = make_log_rows(read_recording(file, None if mapping is None else str(mapping)))
        else:
            read = find_format(file, _READ).read_log(file)
        return cls.of_rows(read.rows, read.columns, read.wrenches, read.ignored)

    def to_dict(self) -> Dict[str, np.ndarray]:
        """Return every column by its name in the CSV file, including topics and wrenches.

        Returns
        -------
        dict of str to ndarray (rows,)
        """
        named = dict(zip(self.columns, self.table.T))
        for topic, fields in self.topics.items():
            named.update((f"{topic}.{field}", column) for field, column in fields.items())
        for term, wrench in self.wrenches.items():
            named.update(zip(list_wrench_columns([term]), wrench.T))
        return named

    def to_dataframe(self) -> Any:
        """Return a pandas DataFrame of the columns of `to_dict`, indexed by the time ``t`` (s).

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        with require_package("log.to_dataframe()", "pandas", "pandas"):
            import pandas
        return pandas.DataFrame(self.to_dict()).set_index("t")

    def __getitem__(self, column: str) -> np.ndarray:
        named = self.to_dict()
        if not isinstance(column, str) or column not in named:
            near = suggest(str(column), list(named))
            raise InputError(
                f"log[{column!r}] does not exist.{near} Use a column of log.to_dict()."
            )
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
        from ..report.html_table import html_title  # slow to import

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
        """Write a CSV file with the fewest digits that preserve every bit.

        The columns of `table` come first. Columns ``TOPIC.FIELD`` of topics follow, then six
        columns for each wrench, ``wrench_NAME.fx`` to ``wrench_NAME.tz``. If `ignored` is not
        empty, a comment below the header lists it.

        Parameters
        ----------
        path : str or path
            Path that ends in ``.csv``.

        Raises
        ------
        InputError
            If the suffix is wrong, or the file cannot be written. No partial file remains.
        """
        self._check_suffix(path, ".csv")
        self.to_file(path)

    def to_mat(self, path: PathLike, layout: str = "vectors") -> None:
        """Write a MATLAB file with each column as a vector.

        Wrenches are matrices ``wrench_NAME``, and topics are structs ``topic_NAME`` with one vector
        per field. If `ignored` is not empty, the cell array ``ignored`` contains it.

        Parameters
        ----------
        path : str or path
            Path that ends in ``.mat``.
        layout : {"vectors", "struct", "matrix", "signals"}, default "vectors"
            "struct", "matrix" and "signals" write one variable ``log``: a struct of the vectors, a
            matrix with the names of its ``columns``, or time and signals as in Simulink.

        Raises
        ------
        InputError
            If the suffix or the layout is wrong, or the file cannot be written. No partial file
            remains.
        """
        self._check_suffix(path, ".mat")
        mat.write_log(_check_path(path), *self._parts(), layout)

    def to_file(self, path: PathLike) -> None:
        """Write a ``.csv``, ``.mat`` or ``.bag`` file, or a ROS 2 bag (``.ros2``).

        Parameters
        ----------
        path : str or path
            Path of the file, or of a new folder for ``.ros2``. The suffix selects the format.

        Raises
        ------
        InputError
            If the suffix is unknown, or the file cannot be written. No partial file remains.
        """
        file = _check_path(path)
        find_format(file, _WRITTEN).write_log(file, *self._parts())

    def _parts(self) -> Tuple[List[str], np.ndarray, Mapping[str, np.ndarray], List[str]]:
        """Return the contents of a file: columns, table, wrenches and `ignored`."""
        columns, table = list(self.columns), self.table
        if self.topics:
            columns += [f"{topic}.{field}" for topic in self.topics for field in self.topics[topic]]
            of_topics = [column for fields in self.topics.values() for column in fields.values()]
            table = np.column_stack([table, *of_topics])
        return columns, table, self.wrenches, self.ignored

    def plot(self, directory: PathLike, formats: Sequence[str] = ()) -> list[Path]:
        """Plot the flight to files.

        Parameters
        ----------
        directory : str or path
            Folder for the files. It is created if it does not exist.
        formats : sequence of str
            Some of "png", "svg" and "pdf" (default: the formats of the command line, else "png").

        Returns
        -------
        list of Path
            Paths of the written files.

        Raises
        ------
        InputError
            If a file cannot be written, or a format does not exist.
        """
        folder = _check_path(directory, "directory")
        chosen = check_formats(formats) if formats else get_formats()
        with LOCK:
            from ..report.log_plots import draw  # matplotlib is slow to import

        with use_formats(chosen):
            drawings = draw(self, folder, is_on_page=False)
        return [folder / file for name in drawings for file in name_files(name, drawings[name])]

    def _check_suffix(self, path: PathLike, suffix: str) -> None:
        if _check_path(path).suffix.lower() != suffix:
            raise InputError(f"{path}: is not a {suffix} file. Name a file that ends in {suffix}.")


def _check_path(path: PathLike, argument: str = "path") -> Path:
    check({argument: path}, {argument: NAME})
    return Path(path)


def check_log_path(path: PathLike) -> None:
    """Raise `InputError` if `Log.to_file` cannot write to `path`."""
    find_format(Path(path), _WRITTEN)
    check_writable(Path(path))


def make_log_file(
    path: Path, columns: Sequence[str], terms: Sequence[str], ignored: Sequence[str]
) -> LogFile:
    """Make a recorder for the format that the suffix of the path selects.

    Parameters
    ----------
    path
        File to write.
    columns
        Columns of the rows.
    terms
        Names of the wrenches to log.
    ignored
        Ignored parts of the model and the world.
    """
    return find_format(path, _WRITTEN).log_file(path, columns, terms, ignored)
