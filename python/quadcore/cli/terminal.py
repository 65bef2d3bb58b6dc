"""What the commands print."""

from __future__ import annotations

import os
import sys
import time
import warnings
from contextlib import contextmanager, suppress
from typing import Any, Callable, Iterator

from rich.console import Console
from rich.progress import BarColumn, Progress, TimeRemainingColumn
from rich.table import Table

from ..support.warning import QuadcoreWarning

_LONG = 1.0  # s; a run that is over sooner needs no progress bar


def prepare() -> None:
    """Make standard output and error take every text, whatever they are connected to."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:  # closed by the caller
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115
        elif hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")


def say(line: str) -> None:
    """Print a line on standard error; if that fails there is nobody to tell."""
    with suppress(OSError):
        print(printable(line), file=sys.stderr)


def forget_output() -> None:
    """Let what standard output could not take go nowhere, so that the flush at exit succeeds."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def printable(text: str) -> str:
    """Escape what would steer a terminal: names of files may hold anything."""
    return "".join(c if c.isprintable() or c == "\n" else ascii(c)[1:-1] for c in text)


class _Console(Console):
    def print(self, *objects: Any, **options: Any) -> None:
        shown = [printable(part) if isinstance(part, str) else part for part in objects]
        super().print(*shown, **options)

    def on_broken_pipe(self) -> None:
        raise BrokenPipeError  # not the exit of status 1 that newer rich makes of it


class _Table(Table):
    def add_row(self, *cells: Any, **options: Any) -> None:
        super().add_row(*(printable(str(cell)) for cell in cells), **options)


def console() -> Console:
    """Make a console without markup that breaks no line unless a terminal needs it."""
    width = None if sys.stdout.isatty() else 10_000
    return _Console(width=width, markup=False, emoji=False, highlight=False)


def table(*columns: str, numbers: bool = False, **options: Any) -> Table:
    """Make a table whose cells wrap, or one of numbers, which do not; the first column never."""
    made = _Table(box=None, pad_edge=False, header_style="bold", **options)
    for i, column in enumerate(columns):
        made.add_column(
            column,
            no_wrap=numbers or i == 0,
            overflow="ellipsis" if numbers else "fold",
            justify="right" if numbers and i else "left",
        )
    return made


@contextmanager
def warnings_as_lines() -> Iterator[None]:
    """Print each QuadcoreWarning once, as a line on standard error."""
    show_others = warnings.showwarning
    said = set()  # "once" is forgotten where a block ignores some

    def show(message: Any, category: Any, *where: Any, **to: Any) -> None:
        if issubclass(category, QuadcoreWarning):
            if str(message) not in said:
                say(f"warning: {message}")
            said.add(str(message))
        else:
            show_others(message, category, *where, **to)

    with warnings.catch_warnings():
        warnings.simplefilter("once", QuadcoreWarning)
        warnings.showwarning = show
        yield


@contextmanager
def progress(quiet: bool, what: str = "flying") -> Iterator[Callable[[int, int], None] | None]:
    """Give a callback that shows the progress of a long run, or None away from a terminal."""
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
    first: int | None = None  # what was there before, of a sweep that goes on

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
