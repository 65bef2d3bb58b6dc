"""Execution of the rows of a sweep: local processes, or an executor of futures."""

from __future__ import annotations

import os
import queue
import threading
from typing import (
    TYPE_CHECKING,
    Any,
    Callable,
    Dict,
    Iterable,
    Iterator,
    List,
    Optional,
    Sequence,
    Union,
)

from ..._core import QuadcoreError
from ...support import interrupts
from ..executor import ProcessDied, count_cores, run_cases
from .batches import fly_together
from .plan import AnyPlan
from .row_file import compute_fingerprint
from .row_spec import (
    FlownRow,
    Row,
    RowSpec,
    compute_digest,
    describe_failure,
    fly_row,
    fly_user_code,
    measure_row,
)

if TYPE_CHECKING:
    import concurrent.futures

Take = Callable[[Row], None]

_ATTEMPTS = 3
"""Number of attempts for a row after its process was killed, possibly because memory ran out."""

_AHEAD = 1024
"""Maximum number of pending tasks of a cluster; each task needs 25 kB."""

_AHEAD_OF_EACH = 2
"""Maximum number of pending tasks per worker of a pool."""

_WORKERS = 16
"""Assumed number of workers of an executor."""

_SHARES = 4
"""Minimum number of tasks per process, for a balanced load."""

_PIECE = 2**16  # bytes; capacity of a pipe

_LOOK = 1.0  # s; interval between checks of the executor


def fly_locally(plan: AnyPlan, rows: Iterable[int], take: Take, processes: Optional[int]) -> None:
    """Run rows in local processes.

    Parameters
    ----------
    plan, rows
        Plan and numbers of the rows.
    take
        Function called with the outcome of each row.
    processes
        Number of processes. None: one per core.
    """
    for attempt in range(1, 1 + _ATTEMPTS):
        attempt_ = _Attempt(plan, take, attempt)
        attempt_.fly(rows, processes)
        if not attempt_.again:
            return
        rows = sorted(attempt_.again)


class _Attempt:
    """One attempt to run rows; rows of a process that was killed need another attempt."""

    def __init__(self, plan: AnyPlan, take: Take, number: int) -> None:
        self.again: List[int] = []
        self._plan, self._take, self._number = plan, take, number
        self._pending: Dict[int, Sequence[int]] = {}

    def fly(self, rows: Iterable[int], processes: Optional[int]) -> None:
        if self._number == 1:
            tasks = _share_out(self._plan, rows, processes or count_cores())
        else:  # a single process can use all the memory
            tasks, processes = _split(rows, 1), 1
        run_cases(
            self._fly_task,
            self._note_tasks(tasks),
            self._take_outcome,
            processes,
            apart=self._plan.apart,
        )

    def _fly_task(self, numbers: Sequence[int]) -> List[Any]:
        specs = [_make_spec(self._plan, number) for number in numbers]
        return list(map(_fly_apart, specs)) if self._plan.apart else _fly_several(specs)

    def _note_tasks(self, tasks: Iterable[Sequence[int]]) -> Iterator[Sequence[int]]:
        for index, numbers in enumerate(tasks):
            self._pending[index] = numbers
            yield numbers

    def _take_outcome(self, index: int, outcome: Union[List[Any], QuadcoreError]) -> None:
        numbers = self._pending.pop(index)
        if not isinstance(outcome, QuadcoreError):
            for row in outcome:
                self._take(measure_row(row))
        elif len(numbers) > 1 or (_may_be_random(outcome) and self._number < _ATTEMPTS):
            self.again.extend(numbers)
        else:
            reason = f"{outcome}, {self._number} times" if self._number > 1 else str(outcome)
            self._take(Row(numbers[0], reason, None, compute_fingerprint(self._plan, numbers[0])))


def fly_on_executor(
    executor: concurrent.futures.Executor,
    plan: AnyPlan,
    rows: Iterable[int],
    take: Take,
    check: Callable[[], None] = lambda: None,
) -> None:
    """Run rows on an executor of futures.

    Parameters
    ----------
    executor
        Executor with processes that can import quadcore.
    plan, rows, take
        As for `fly_locally`.
    check
        Function called at intervals; it raises an error if the executor has failed.

    Raises
    ------
    QuadcoreError
        If the executor fails. `take` has then received the completed rows.
    """
    waiting = _share_out(plan, rows, _WORKERS)
    at_most = _AHEAD_OF_EACH * getattr(executor, "_max_workers", _AHEAD // _AHEAD_OF_EACH)
    pending: Dict[Any, Sequence[int]] = {}
    ended: queue.SimpleQueue[Any] = queue.SimpleQueue()

    def hand_out(numbers: Sequence[int]) -> None:
        specs = [_make_spec(plan, number) for number in numbers]
        future = executor.submit(fly_all, specs, plan.apart)
        pending[future] = numbers
        future.add_done_callback(ended.put)

    try:
        for numbers in waiting:
            hand_out(numbers)
            if len(pending) >= at_most:
                break
        while pending:
            try:
                future = ended.get(timeout=_LOOK)
            except queue.Empty:
                check()
                continue
            numbers = pending.pop(future)
            with interrupts.hold_signals():
                for row in _collect(plan, future, numbers):
                    if isinstance(row, Row):
                        take(row)
                    else:
                        hand_out([row])
            for following in waiting:
                hand_out(following)
                break
    except (QuadcoreError, KeyboardInterrupt, MemoryError):
        raise
    except Exception as error:
        _shut_down_broken(executor, error)
        check()
        raise QuadcoreError(_describe_executor_failure(error)) from error
    finally:
        for future in pending:
            future.cancel()


def _shut_down_broken(executor: concurrent.futures.Executor, error: Exception) -> None:
    """Shut down a broken pool without waiting for it.

    Its ``with`` block may never end, because a thread may block on a full pipe that no process
    reads (CPython issue 94777).
    """
    from concurrent.futures import BrokenExecutor

    if not isinstance(error, BrokenExecutor):
        return
    calls = getattr(executor, "_call_queue", None)
    if calls is not None:
        _drain(calls)
    executor.shutdown(wait=False)


def _drain(calls: Any) -> None:
    """Read the pipe of a queue to its end, in another thread."""
    try:
        # A copy, because the queue's thread closes its own descriptor.
        pipe = os.dup(calls._reader.fileno())
    except OSError:  # the pipe is already closed
        return
    try:
        is_pipe = os.path.samestat(os.fstat(pipe), os.fstat(calls._writer.fileno()))
    except OSError:
        is_pipe = False
    if not is_pipe:  # the pipe was closed, and its number now belongs to another file
        os.close(pipe)
        return

    def read_all() -> None:
        with open(pipe, "rb", buffering=0) as stream:
            while stream.read(_PIECE):
                pass

    threading.Thread(target=read_all, daemon=True).start()


def fly_all(specs: Sequence[Union[RowSpec, Row]], apart: bool) -> List[Row]:
    """Run several rows in the process that received them."""
    flown: List[Row] = []
    if apart:  # user-defined controllers may keep state between flights

        def take_outcome(index: int, outcome: Union[FlownRow, Row, QuadcoreError]) -> None:
            if isinstance(outcome, QuadcoreError):
                spec = specs[index]
                outcome = Row(spec.row, str(outcome), None, _get_fingerprint(spec))
            flown.append(measure_row(outcome))

        run_cases(_fly_apart, specs, take_outcome, 1, apart=True)
        return flown
    return _fly_several(specs)


def _fly_several(specs: Sequence[Union[RowSpec, Row]]) -> List[Row]:
    """Run rows on one batch if possible, else one by one."""
    if len(specs) > 1:
        together = fly_together([spec for spec in specs if not isinstance(spec, Row)])
        if together is not None and len(together) == len(specs):
            return together
    return [_fly_row(spec) for spec in specs]


def _fly_row(spec: Union[RowSpec, Row]) -> Row:
    return spec if isinstance(spec, Row) else fly_row(spec)


def _fly_apart(spec: Union[RowSpec, Row]) -> Union[FlownRow, Row]:
    return spec if isinstance(spec, Row) else fly_user_code(spec)


def _get_fingerprint(spec: Union[RowSpec, Row]) -> str:
    return spec.fingerprint if isinstance(spec, Row) else spec.fingerprint()


def _make_spec(plan: AnyPlan, number: int) -> Union[RowSpec, Row]:
    """Return the specification of a row, or its failure."""
    try:
        return plan.make_spec(number)
    except QuadcoreError as error:
        return Row(number, describe_failure(error), None, compute_digest(str(error).encode()))


def _share_out(plan: AnyPlan, rows: Iterable[int], processes: int) -> Iterator[Sequence[int]]:
    """Split rows into tasks of a suitable size."""
    return _split(rows, max(1, min(plan.at_once, len(plan) // (_SHARES * processes))))


def _split(rows: Iterable[int], count: int) -> Iterator[Sequence[int]]:
    piece: List[int] = []
    for row in rows:
        piece.append(row)
        if len(piece) == count:
            yield piece
            piece = []
    if piece:
        yield piece


def _may_be_random(outcome: QuadcoreError) -> bool:
    return isinstance(outcome, ProcessDied) and outcome.was_killed


def _collect(plan: AnyPlan, future: Any, numbers: Sequence[int]) -> Iterator[Union[Row, int]]:
    """Yield the rows of a task; if the worker died, yield the row numbers of a larger task."""
    try:
        yield from future.result()
        return
    except Exception as error:
        # Dask raises this error if the task has killed several workers.
        if type(error).__name__ != "KilledWorker":
            raise
    if len(numbers) > 1:
        yield from numbers
    else:
        text = "its worker died, several times"
        yield Row(numbers[0], text, None, compute_fingerprint(plan, numbers[0]))


def _describe_executor_failure(error: Exception) -> str:
    reason = " ".join(f"{type(error).__name__}: {error}".split())
    return (
        f"the executor failed ({reason[:200]}). The completed rows are kept. Add --resume to "
        "continue."
    )
