"""Rows flown by a Dask cluster."""

from __future__ import annotations

from contextlib import contextmanager
from typing import Any, Callable, Iterator, Tuple

from .._core import QuadcoreError
from ..extras import needed

_PATIENCE = 30.0  # s; for a scheduler to answer


@contextmanager
def cluster(address: str) -> Iterator[Tuple[Any, Callable[[], None]]]:
    """Be a client of a scheduler.

    Parameters
    ----------
    address
        Of it, ``tcp://HOST:PORT``.

    Returns
    -------
    tuple
        An executor, and what raises `QuadcoreError` when the scheduler is gone.

    Raises
    ------
    QuadcoreError
        No scheduler answers.
    """
    with needed("--dask", "distributed", "dask"):
        from distributed import Client

    try:
        client = Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise QuadcoreError(f"{address}: no scheduler answers: {reason[:200]}") from error

    def check() -> None:
        if client.status != "running":
            raise QuadcoreError(
                f"{address}: the scheduler is gone; the rows so far are kept, --resume flies the "
                "rest"
            )

    try:
        yield client.get_executor(pure=False), check
    finally:
        client.close(timeout=1)
