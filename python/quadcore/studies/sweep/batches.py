"""Rows that run together on one batch."""

from __future__ import annotations

from functools import partial
from typing import List, Optional, Sequence

import numpy as np

from ... import _core
from ..._core import QuadcoreError
from ...simulation.flight import count_steps
from ...simulation.flight_plan import FlightPlan
from ...simulation.log import Log
from ...support.warning import suppress_warnings
from .. import measured_flight
from ..time_limit import time_limit
from . import motion_metrics
from .row_spec import Flight, Row, RowSpec

ENGINE = "eigen"
"""Engine of the batches."""

_SLIP = 1e-9  # s; tolerance of command times, as in a separate flight


def fly_together(specs: Sequence[RowSpec]) -> Optional[List[Row]]:
    """Simulate rows on one batch, bit-identical to separate flights.

    Parameters
    ----------
    specs
        Descriptions of the rows.

    Returns
    -------
    list of Row, or None
        Completed rows; None if the rows cannot share a batch.
    """
    flights = [spec for spec in specs if isinstance(spec, Flight)]
    if len(flights) < max(2, len(specs)):
        return None
    if all(spec.own is None and spec.plan.controller is not None for spec in flights):
        return _fly_guided(flights)
    if not _are_alike([spec.plan for spec in flights]):
        return None
    try:
        with time_limit(len(flights) * flights[0].limit), suppress_warnings():
            return _fly(flights)
    except QuadcoreError:  # separate flights show which row is invalid
        return None


def _fly_guided(flights: Sequence[Flight]) -> Optional[List[Row]]:
    """Simulate rows with controllers on one batch, if they can share a batch."""
    plans = [partial(getattr, spec, "plan") for spec in flights]
    first = flights[0]
    outcomes = measured_flight.fly_together(plans, first.limit, first.criteria)
    if outcomes is None:
        return None
    return [
        Row(
            spec.row,
            " ".join(outcome.failure.split()),
            None if outcome.failure else outcome.measures,
            spec.fingerprint(),
        )
        for spec, outcome in zip(flights, outcomes)
    ]


def _are_alike(plans: Sequence[FlightPlan]) -> bool:
    """Whether plans differ only in vehicle, pose and seed."""
    first = plans[0]
    return (
        first.engine == ENGINE
        and first.commands is not None
        and first.rotor_velocity is None
        and all(
            plan.controller is None
            and plan.world is first.world
            and plan.commands is first.commands
            and (plan.engine, plan.dt, plan.duration, plan.log_every)
            == (first.engine, first.dt, first.duration, first.log_every)
            for plan in plans
        )
    )


def _fly(flights: Sequence[Flight]) -> List[Row]:
    plans = [spec.plan for spec in flights]
    first = plans[0]
    assert first.commands is not None
    batch = _core.Batch(
        [plan.model for plan in plans],
        first.world,
        first.engine,
        first.dt,
        [dict(plan.parameters) for plan in plans],
        np.array([plan.spawn for plan in plans]),
        np.array([plan.seed for plan in plans], np.uint64),
        1,
    )
    steps = count_steps(first.duration, batch.dt)
    logged = range(0, steps + 1, first.log_every)
    tables = np.empty((len(plans), len(logged), batch.log_width))
    state = np.empty((len(plans), batch.state_width))
    # Step at which each row of the commands becomes valid.
    begins = np.ceil((first.commands[:, 0] - _SLIP) / batch.dt).astype(int)
    stops = sorted({*logged, *begins[(begins > 0) & (begins < steps)].tolist()})
    flown = row = 0
    for stop in stops:
        if stop > flown:
            batch.step(None, stop - flown)
            flown = stop
        if stop % first.log_every == 0:
            batch._write_state(state)
            tables[:, row, 0] = stop * batch.dt
            tables[:, row, 1:] = state[:, : batch.log_width - 1]
            row += 1
        now = int(np.searchsorted(begins, stop, "right")) - 1
        if now >= 0 and (begins[now] == stop or stop == 0):
            held = np.broadcast_to(first.commands[now, 1:], (len(plans), batch.command_width))
            batch.step(np.ascontiguousarray(held), 0)
    return [
        Row(spec.row, failure, None if failure else motion_metrics.measure(Log(table, {})), print_)
        for spec, failure, table, print_ in zip(
            flights, batch.failures, tables, [spec.fingerprint() for spec in flights]
        )
    ]
