"""Text output of the commands."""

from __future__ import annotations

import os
import sys
import time
import warnings
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Callable, Iterable, Iterator

from rich.console import Console
from rich.progress import BarColumn, Progress, TimeRemainingColumn
from rich.table import Table

from ..studies.table import make_json
from ..support.warning import QuadcoreWarning

_LONG = 1.0  # s; shorter runs have no progress bar


def prepare_streams() -> None:
    """Make standard output and standard error accept any text."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:  # closed by the caller
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115
        elif hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")


def print_message(line: str) -> None:
    """Print a line to standard error; do nothing if it is closed."""
    with suppress(OSError):
        print(escape_controls(line), file=sys.stderr)


def discard_output() -> None:
    """Discard pending standard output, so that the flush at exit succeeds."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@contextmanager
def discard_if_unread() -> Iterator[None]:
    """Continue after a block that prints to a reader that has ended, such as `head`."""
    try:
        yield
    except BrokenPipeError:
        discard_output()


def escape_controls(text: str) -> str:
    """Escape control characters, which file names may contain."""
    return "".join(c if c.isprintable() or c == "\n" else ascii(c)[1:-1] for c in text)


class _Console(Console):
    def print(self, *objects: Any, **options: Any) -> None:
        shown = [escape_controls(part) if isinstance(part, str) else part for part in objects]
        super().print(*shown, **options)

    def on_broken_pipe(self) -> None:
        raise BrokenPipeError  # newer versions of rich would exit with status 1


class _Table(Table):
    def add_row(self, *cells: Any, **options: Any) -> None:
        super().add_row(*(escape_controls(str(cell)) for cell in cells), **options)


def make_console() -> Console:
    """Make a console without markup that wraps lines only on a terminal."""
    width = None if sys.stdout.isatty() else 10_000
    return _Console(width=width, markup=False, emoji=False, highlight=False)


def make_table(*columns: str, numbers: bool = False, **options: Any) -> Table:
    """Make a table; cells wrap, except in the first column and in tables of numbers."""
    made = _Table(box=None, pad_edge=False, header_style="bold", **options)
    for i, column in enumerate(columns):
        made.add_column(
            column,
            no_wrap=numbers or i == 0,
            overflow="ellipsis" if numbers else "fold",
            justify="right" if numbers and i else "left",
        )
    return made


def print_written(files: Iterable[Path]) -> None:
    """Print the paths of the written files, one per line."""
    for file in files:
        make_console().print(f"written {file}")


def print_json(content: Any) -> None:
    """Print plain values as JSON."""
    print(make_json(content).decode(), end="")


@contextmanager
def print_warnings() -> Iterator[None]:
    """Print each QuadcoreWarning once, as a line on standard error."""
    show_others = warnings.showwarning
    printed = set()  # Python forgets "once" after a block that ignores warnings

    def show(message: Any, category: Any, *where: Any, **to: Any) -> None:
        if issubclass(category, QuadcoreWarning):
            if str(message) not in printed:
                print_message(f"warning: {message}")
            printed.add(str(message))
        else:
            show_others(message, category, *where, **to)

    with warnings.catch_warnings():
        warnings.simplefilter("once", QuadcoreWarning)
        warnings.showwarning = show
        yield


@contextmanager
def show_progress(
    quiet: bool, what: str = "simulating"
) -> Iterator[Callable[[int, int], None] | None]:
    """Provide a callback that shows the progress of a long run; None without a terminal."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    started = time.monotonic()
    columns = (
        "{task.description}",
        BarColumn(),
        "{task.percentage:>3.0f}%",
        TimeRemainingColumn(),
        "{task.fields[rate]}",
    )
    with_bar = Progress(*columns, console=Console(stderr=True), transient=True)
    task = with_bar.add_task(what, rate="")
    first: int | None = None  # number of rows that a resumed sweep already has

    def report(done: int, total: int) -> None:
        nonlocal first
        first = done if first is None else first
        taken = time.monotonic() - started
        if taken > _LONG:
            with_bar.start()
        rate = f"{(done - first) / taken:.3g}/s" if done > first else ""
        with_bar.update(task, completed=done, total=total, rate=rate)

    try:
        yield report
    finally:
        with_bar.stop()
