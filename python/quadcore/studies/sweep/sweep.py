"""Sweeps, which can be interrupted and resumed."""

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
from ...simulation.engines import STUDY_ENGINE, AnyEngineName
from ...support import arguments, interrupts
from ..accept_options import accept_options
from ..control_setup import Controllers, References
from ..options import CriteriaKeywords, Names, Progress, SweepOptions, choose_engines
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
    """Results of a sweep.

    Attributes
    ----------
    columns : dict of str to ndarray
        Columns by name: ``row``, the conditions, ``failure`` ("" for success), the metrics (NaN
        after a failure), and ``fingerprint``. Both pandas and polars convert the dictionary to a
        DataFrame.
    sensitivities : list of dict
        Sensitivity of each metric to each parameter; see `compute_sensitivities`.
    """

    columns: Dict[str, np.ndarray]
    sensitivities: List[Dict[str, Any]]

    def __repr__(self) -> str:
        return f"<Sweep, {count_outcomes(self.columns['failure'].tolist())}>"


@accept_options(
    SweepOptions,
    engines=arguments.NAMES,
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
    engines: Union[AnyEngineName, Sequence[AnyEngineName]] = STUDY_ENGINE,
    engine: Optional[AnyEngineName] = None,
    models: Names = "quadrotor",
    out: Optional[Union[str, Path]] = None,
    parquet: bool = False,
    resume: bool = False,
    executor: Optional[concurrent.futures.Executor] = None,
    dask: Optional[str] = None,
    **options: Unpack[CriteriaKeywords],
) -> Sweep:
    """Simulate many flights over a grid or random samples of parameters.

    Parameters
    ----------
    controllers, references
        As for `evaluate`.
    vary
        Values by axis, as for `evaluate`: a list, a text (``"0.9:1.1:5"``, ``"log:1:100:9"`` or
        ``"normal:1:0.1"``), or a distribution with a method ``ppf``, such as those of
        ``scipy.stats``.
    commands
        Rotor commands of an open-loop flight, instead of controllers and references.
    function, measures
        Function to call instead of simulating flights. It is called with a dictionary of the values
        of a point. It returns a number, or a mapping with the names in `measures`.
    points
        CSV file with a header of axis names and one point per row.
    design, samples
        Sampling of the axes with a distribution ("latin", "sobol", "random" or "saltelli"), and
        number of samples. The samples depend on `seed`.
    engines, engine, models
        As for `evaluate`.
    out
        Folder for ``table.csv``. Each completed row is appended at once, and the file is sorted at
        the end.
    parquet
        Whether to write ``table.parquet`` as well.
    resume
        Whether to continue the sweep in `out` and keep its completed rows.
    executor
        Executor with the interface of ``concurrent.futures``, instead of `processes`.
    dask
        Address of a Dask scheduler, instead of `processes`.
    **options

    Returns
    -------
    Sweep
        Results, which do not depend on where and in which order the rows run.

    Raises
    ------
    InputError
        If an argument is invalid (before the first row), or if the disk is full. Completed rows are
        kept.
    QuadcoreError
        If the executor or the scheduler fails. Completed rows are kept.
    KeyboardInterrupt
        On Ctrl-C. Completed rows are kept.
    """
    shared = SweepOptions(**options)
    made, shared = make_design(vary or {}, shared, points, design, samples)
    plan: AnyPlan
    if function is not None:
        if (controllers, references, commands) != (None, None, None):
            raise InputError(
                "function replaces flights. Give it without controllers, references and commands."
            )
        plan = Calls(made, function, arguments.to_list(measures), shared.time_limit)
    else:
        names = choose_engines(engine, engines), arguments.to_list(models)
        plan = Plan(made, controllers, references, *names, shared, commands)
    with ExitStack() as stack:
        if out is None:
            if resume or parquet:
                raise InputError("resume and parquet need a folder. Give out.")
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
    """Simulate the missing rows of a plan; the parameters are those of `sweep`."""
    if executor is not None and dask is not None:
        raise InputError("both executor and dask are given. Give one of them.")
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
