"""Errors of the state that a controller estimates in its attribute `estimate`."""

from __future__ import annotations

from typing import Any, List

import numpy as np

from .._core import InputError
from ..support.arguments import shorten
from ..support.rotation import compute_rotation_vector

QUANTITIES = ("position", "linear_velocity", "orientation")
"""Attributes of an estimate, named as those of the odometry; some of them may be missing."""


class EstimateErrors:
    """Errors of a controller's estimate at each call.

    Parameters
    ----------
    controller
        Controller. Its `estimate` has some of the attributes `QUANTITIES`, and optionally the
        `covariance` of their errors in this order. Errors of position (m) and velocity (m/s) are in
        world axes. The error of the orientation is the rotation vector from the true to the
        estimated orientation in frame axes, rad. A call without an estimate gives a row of NaN.
    """

    def __init__(self, controller: Any) -> None:
        self._controller = controller
        self._rows: List[np.ndarray] = []

    @property
    def rows(self) -> np.ndarray:
        """Errors of all `QUANTITIES`, then the normalised error; shape (calls, 10).

        For an error e with n components and covariance P, the normalised error is e' P^-1 e / n.
        Its expectation is 1 if the covariance is correct. Quantities that the controller does not
        estimate are NaN. Reference: Y. Bar-Shalom, X. R. Li, T. Kirubarajan, Estimation with
        Applications to Tracking and Navigation, 2001, section 5.4.
        """
        return np.array(self._rows).reshape(-1, 3 * len(QUANTITIES) + 1)

    def note(self, truth: Any) -> None:
        """Compare the estimate with the true state.

        Raises
        ------
        InputError
            If the estimate has a wrong shape, or its covariance is not positive definite.
        """
        row = np.full(3 * len(QUANTITIES) + 1, np.nan)
        estimate = getattr(self._controller, "estimate", None)
        if estimate is not None:
            self._compare(estimate, truth, row)
        self._rows.append(row)

    def _compare(self, estimate: Any, truth: Any, row: np.ndarray) -> None:
        known: List[int] = []
        for i, name in enumerate(QUANTITIES):
            given = getattr(estimate, name, None)
            if given is None:
                continue
            true = np.asarray(getattr(truth, name))
            value = _read(f"estimate.{name}", given, true.shape)
            known += range(3 * i, 3 * i + 3)
            is_attitude = name == "orientation"
            row[known[-3:]] = (
                compute_rotation_vector(true, value / np.linalg.norm(value))
                if is_attitude
                else value - true
            )
        covariance = getattr(estimate, "covariance", None)
        if covariance is None or not known:
            return
        size = (len(known), len(known))
        try:
            factor = np.linalg.cholesky(_read("estimate.covariance", covariance, size))
        except np.linalg.LinAlgError:
            raise InputError(
                "controller: its estimate.covariance is not positive definite. Correct the "
                "estimator."
            ) from None
        normalised = np.linalg.solve(factor, row[known])
        row[-1] = normalised @ normalised / len(known)


def _read(name: str, given: Any, shape: Any) -> np.ndarray:
    try:
        value = np.array(given, dtype=float)
    except (TypeError, ValueError):
        value = np.empty(0)
    if value.shape != shape or not np.isfinite(value).all():
        raise InputError(
            f"controller: its {name} is {shorten(given)}. Give finite numbers of shape {shape}."
        )
    return value
