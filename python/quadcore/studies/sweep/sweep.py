"""Flying a sweep, and going on with one."""

from __future__ import annotations

import tempfile
from contextlib import ExitStack
from pathlib import Path
from typing import (
    TYPE_CHECKING,
    Any,
    Callable,
    Dict,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Union,
)

import numpy as np

from ..._core import InputError
from ...simulation.commands import CommandsLike
from ...simulation.engines import AnyEngineName
from ...support import arguments, interrupts
from ..control_setup import Controllers, References
from ..options import Keywords, Names, Progress, SweepOptions, accept_options, choose_engines
from ..output_folder import output_folder
from ..table import count_outcomes
from .dask import connect_cluster
from .execution import fly_locally, fly_on_executor
from .plan import AnyPlan, Calls, Plan, make_design
from .row_file import RowFile
from .row_spec import Row
from .sensitivity import compute_sensitivities
from .table import make_table, write_parquet

if TYPE_CHECKING:
    import concurrent.futures

    from typing_extensions import Unpack

TABLE = "table.csv"
PARQUET = "table.parquet"


class Sweep(NamedTuple):
    """What became of the rows.

    Attributes
    ----------
    columns : dict of str to ndarray
        By name: ``row``, what flew, ``failure`` ("" if it flew), the measures, NaN where it failed,
        and ``fingerprint``. pandas and polars make a DataFrame of it.
    sensitivities : list of dict
        What each measure is sensitive to, see `sensitivity`.
    """

    columns: Dict[str, np.ndarray]
    sensitivities: List[Dict[str, Any]]

    def __repr__(self) -> str:
        return f"<Sweep, {count_outcomes(self.columns['failure'].tolist())}>"


@accept_options(
    SweepOptions,
    engines=arguments.or_none(arguments.NAMES),
    engine=arguments.or_none(arguments.NAME),
    models=arguments.NAMES,
    vary=arguments.or_none(arguments.VALUES),
    points=arguments.or_none(arguments.NAME),
    design=arguments.NAME,
    measures=arguments.NAMES,
    out=arguments.or_none(arguments.NAME),
    executor=arguments.or_none((lambda value: hasattr(value, "submit"), "what has submit()")),
    dask=arguments.or_none((lambda value: isinstance(value, str), "tcp://HOST:PORT")),
    samples=arguments.or_none(arguments.COUNT),
    resume=arguments.FLAG,
    parquet=arguments.FLAG,
)
def sweep(
    controllers: Optional[Controllers] = None,
    references: Optional[References] = None,
    vary: Optional[Mapping[str, Any]] = None,
    *,
    commands: Optional[CommandsLike] = None,
    function: Optional[Callable[[Dict[str, Any]], Any]] = None,
    measures: Union[str, Sequence[str]] = "value",
    points: Optional[Union[str, Path]] = None,
    design: str = "latin",
    samples: Optional[int] = None,
    engines: Union[AnyEngineName, Sequence[AnyEngineName], None] = None,
    engine: Optional[AnyEngineName] = None,
    models: Names = "quadrotor",
    out: Optional[Union[str, Path]] = None,
    parquet: bool = False,
    resume: bool = False,
    executor: Optional[concurrent.futures.Executor] = None,
    dask: Optional[str] = None,
    **options: Unpack[Keywords],
) -> Sweep:
    """Fly thousands of flights, each described so that it can be flown anywhere.

    Parameters
    ----------
    controllers, references
        As for `evaluate`.
    vary
        By axis, as for `evaluate`, its values: a list; a text, ``"0.9:1.1:5"``, ``"log:1:100:9"``
        or ``"normal:1:0.1"``; or a distribution, that is what has a method ppf, such as those of
        scipy.stats.
    commands
        Flown open loop, in the place of controllers and references.
    function, measures
        In the place of flights: called with a dictionary of a point's values; returns a number, or
        a mapping with these names.
    points
        A CSV file whose rows are points of the axes in its header.
    design, samples
        How axes with a distribution are drawn: "latin", "sobol", "random" or "saltelli"; and how
        many points, from `seed` on.
    engines, engine, models
        As for `evaluate`.
    out
        A folder in which ``table.csv`` grows by whole rows, in order once all are there.
    parquet
        Whether to write ``table.parquet``, too, at the end.
    resume
        Whether to go on with what is there: nothing is flown twice.
    executor
        Any of concurrent.futures' kind, in the place of `processes`.
    dask
        Address of a scheduler, in the place of `processes`.
    **options

    Returns
    -------
    Sweep
        The same whatever flew it, in whatever order.

    Raises
    ------
    InputError
        Nothing was flown; or the disk is full, what was written being kept.
    QuadcoreError
        What should fly is gone; what was written is kept.
    KeyboardInterrupt
        What was written is kept.
    """
    shared = SweepOptions(**options)
    made, shared = make_design(vary or {}, shared, points, design, samples)
    plan: AnyPlan
    if function is not None:
        if (controllers, references, commands) != (None, None, None):
            raise InputError("a function is called in the place of flights; give it, or these")
        plan = Calls(made, function, arguments.several(measures), shared.time_limit)
    else:
        names = choose_engines(engine, engines), arguments.several(models)
        plan = Plan(made, controllers, references, *names, shared, commands)
    with ExitStack() as stack:
        if out is None:
            if resume or parquet:
                raise InputError("resume and parquet need out; name a folder")
            out = stack.enter_context(tempfile.TemporaryDirectory())
        folder = Path(out)
        stack.enter_context(output_folder(folder))
        rows = fly_plan(
            plan, folder, resume, parquet, shared.processes, executor, dask, shared.progress
        )
        columns = make_table(rows)
    return Sweep(columns, compute_sensitivities(plan, columns))


def fly_plan(
    plan: AnyPlan,
    folder: Path,
    resume: bool = False,
    parquet: bool = False,
    processes: Optional[int] = None,
    executor: Optional[concurrent.futures.Executor] = None,
    dask: Optional[str] = None,
    progress: Optional[Progress] = None,
) -> RowFile:
    """Fly what is missing of a plan; parameters as for `sweep`."""
    if executor is not None and dask is not None:
        raise InputError("executor and dask are given; keep one")
    rows = RowFile(folder / TABLE, plan, resume)
    flown = rows.count

    def take(row: Row) -> None:
        nonlocal flown
        rows.take(row)
        flown += 1
        if progress is not None:
            progress(flown, len(plan))

    try:
        if dask is not None:
            with connect_cluster(dask) as (of_dask, check):
                fly_on_executor(of_dask, plan, rows.missing, take, check)
        elif executor is not None:
            fly_on_executor(executor, plan, rows.missing, take)
        else:
            fly_locally(plan, rows.missing, take, processes)
    finally:
        with interrupts.hold_signals():
            rows.close()
            if parquet:
                write_parquet(rows, folder / PARQUET)
    return rows
