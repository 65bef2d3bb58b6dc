"""Dask clusters as executors."""

from __future__ import annotations

from contextlib import contextmanager
from typing import Any, Callable, Iterator, Tuple

from ..._core import QuadcoreError
from ...support.optional_packages import require_package

_PATIENCE = 30.0  # s; time limit of the connection


@contextmanager
def connect_cluster(address: str) -> Iterator[Tuple[Any, Callable[[], None]]]:
    """Connect to a scheduler during the block.

    Parameters
    ----------
    address
        Address of the scheduler, ``tcp://HOST:PORT``.

    Returns
    -------
    tuple
        Executor, and a function that raises `QuadcoreError` after the connection is lost.

    Raises
    ------
    QuadcoreError
        If no scheduler answers at the address.
    """
    with require_package("--dask", "distributed", "dask"):
        from distributed import Client

    with _silence_loggers():
        yield from _connect(Client, address)


def _connect(make: Any, address: str) -> Iterator[Tuple[Any, Callable[[], None]]]:
    try:
        client = make(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise QuadcoreError(f"{address}: no scheduler answers: {reason[:200]}") from error

    def check() -> None:
        if client.status != "running":
            raise QuadcoreError(
                f"{address}: the connection to the scheduler is lost. The completed rows are kept. "
                "Add --resume to continue."
            )

    try:
        yield client.get_executor(pure=False), check
    finally:
        client.close(timeout=1)


@contextmanager
def _silence_loggers() -> Iterator[None]:
    """Silence the log messages of the client; `check` reports a lost scheduler."""
    import logging

    known = logging.root.manager.loggerDict
    names = [name for name in known if name.partition(".")[0] in ("distributed", "tornado")]
    loggers = [logging.getLogger(name) for name in names]
    before = [logger.level for logger in loggers]
    try:
        for logger in loggers:
            logger.setLevel(logging.CRITICAL)
        yield
    finally:
        for logger, level in zip(loggers, before):
            logger.setLevel(level)
