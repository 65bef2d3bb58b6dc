"""Plots of a sweep."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from ...report.colours import PALETTE
from ...report.decimation import pick_evenly
from ...report.plots import dress, make_figure, panels
from ..figures import Figures
from .plan import AnyPlan
from .sensitivity import COMBINATION, list_combinations, list_numeric_axes, measure_effect

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NAMES = ("measure", "sensitivity", "surface", "parallel")

_COMBINATIONS = 4  # maximum number in a figure
_AXES = 12
_LINES = 600
_WIDE = 30  # ratio of maximum to minimum above which the colour scale is logarithmic
_COLOURS = "viridis"

Columns = Mapping[str, np.ndarray]


def list_figures(
    plan: AnyPlan, columns: Columns, sensitivities: Sequence[Mapping[str, Any]], measure: str
) -> Figures:
    """List the figures of the distribution and the sensitivities of a metric.

    Parameters
    ----------
    plan, columns, sensitivities
        Plan, results and sensitivities of the sweep.
    measure
        Metric to draw.
    """
    found = list(list_combinations(columns))
    parts = [
        (
            _make_label(names, [other for other, _ in found]),
            chosen[np.isfinite(columns[measure][chosen])],
        )
        for names, chosen in found
    ]
    parts = [part for part in parts if len(part[1]) > 1]
    if not parts:
        return {}
    note = f" ({_COMBINATIONS} of {len(parts)} combinations)" if len(parts) > _COMBINATIONS else ""
    parts = parts[:_COMBINATIONS]
    label = f"{measure} ({plan.units[measure]})" if plan.units[measure] else measure
    rows = {_make_label(names, [other for other, _ in found]): len(at) for names, at in found}
    figures: Figures = {
        "measure": partial(_draw_distribution, parts, rows, columns[measure], label, note)
    }
    axes = list_numeric_axes(plan, columns)[:_AXES]
    found_rows = [row for row in sensitivities if row["measure"] == measure and row["axis"] in axes]
    if found_rows:
        figures["sensitivity"] = partial(_draw_sensitivity, found_rows, measure)
        leading = _leading_axes(found_rows)
        figures["surface"] = partial(_draw_surface, parts, columns, leading, measure, label, note)
    if len(axes) > 1:
        figures["parallel"] = partial(_draw_parallel, parts, columns, axes, measure, label, note)
    return figures


Parts = List[Tuple[str, np.ndarray]]


def _make_label(names: Mapping[str, str], among: Sequence[Mapping[str, str]]) -> str:
    """Label a combination by the names that differ between combinations."""
    return ", ".join(v for k, v in names.items() if len({other[k] for other in among}) > 1)


def _colour_scale(values: np.ndarray) -> Any:
    """Return a colour scale, which is logarithmic if the values span orders of magnitude."""
    from matplotlib.colors import LogNorm, Normalize

    low, high = values.min(), values.max()
    scale = LogNorm if low > 0 and high > _WIDE * low else Normalize
    return scale(low, high if high > low else low + 1)


def _draw_distribution(
    parts: Parts, rows: Mapping[str, int], values: np.ndarray, label: str, note: str
) -> Figure:
    """Draw the cumulative distributions; failed rows count as infinite."""
    title = f"Cumulative distribution of {label}{note}"
    figure, grid = panels(title, 1, height=2.8, above=0.7)
    axes = grid[0, 0]
    for i, (named, chosen) in enumerate(parts):
        found = np.sort(values[chosen])
        share = np.arange(1, 1 + len(found)) / rows[named]
        axes.step(found, share, where="post", label=named, color=PALETTE[i])
    if values[np.concatenate([chosen for _, chosen in parts])].min() > 0:
        axes.set_xscale("log")
    axes.set_xlabel(label)
    axes.set_ylabel("share of the rows (1)")
    axes.set_ylim(0, 1)
    _add_legend(figure, axes, parts)
    return figure


def _draw_sensitivity(rows: Sequence[Mapping[str, Any]], measure: str) -> Figure:
    is_sobol = any(np.isfinite(row["total"]) for row in rows)
    what = "Sobol index" if is_sobol else "PAWN index"
    height = 1.1 + 0.3 * len(rows)
    figure = make_figure(f"Sensitivity of {measure}", 8, height)
    axes = figure.add_axes((0.45, 0.5 / height, 0.52, 1 - 1.0 / height))
    dress(axes)
    places = np.arange(len(rows))[::-1]
    if is_sobol:
        for name, shift, colour in (("first", 0.2, PALETTE[0]), ("total", -0.2, PALETTE[1])):
            widths = [row[name] for row in rows]
            ends = [row[f"{name}_interval"] for row in rows]
            axes.barh(
                places + shift,
                widths,
                xerr=ends,
                height=0.36,
                color=colour,
                label=f"{name} order" if name == "first" else name,
                capsize=2,
            )
        axes.legend(frameon=False, fontsize="small")
    else:
        axes.barh(
            places,
            [row["pawn"] for row in rows],
            xerr=[row["pawn_interval"] for row in rows],
            height=0.6,
            color=PALETTE[0],
            capsize=2,
        )
        noise = [row["pawn_noise"] for row in rows]
        axes.plot(noise, places, "|", color="black", markersize=12, label="95 % without effect")
        axes.set_xlim(0, 1)
        axes.legend(frameon=False, fontsize="small")
    axes.set_xlabel(f"{what} (1), with 95 % interval")
    axes.axvline(0, color="black", linewidth=0.8)
    axes.set_yticks(places)
    named = [{name: row[name] for name in COMBINATION if name in row} for row in rows]
    labels = [(_make_label(names, named), row["axis"]) for names, row in zip(named, rows)]
    axes.set_yticklabels([": ".join(filter(None, each)) for each in labels], fontsize="small")
    return figure


def _leading_axes(rows: Sequence[Mapping[str, Any]]) -> List[str]:
    """Return the two axes with the strongest effects."""
    weight: Dict[str, float] = {}
    for row in rows:
        weight[row["axis"]] = max(weight.get(row["axis"], 0.0), measure_effect(row))
    return sorted(weight, key=lambda axis: -weight[axis])[:2]


def _draw_surface(
    parts: Parts, columns: Columns, leading: Sequence[str], measure: str, label: str, note: str
) -> Figure:
    height = 3.2
    title = f"Response surface of {measure}: rows (dots) and quadratic fit (background){note}"
    figure = make_figure(title, 8, height)
    grid = figure.subplots(
        1,
        len(parts),
        squeeze=False,
        gridspec_kw={"left": 0.14, "right": 0.95, "top": 0.82, "bottom": 0.2, "wspace": 0.45},
    )
    for axes, (named, chosen) in zip(grid[0], parts):
        dress(axes)
        picked = chosen[pick_evenly(len(chosen), 4 * _LINES)]
        values = columns[measure]
        x = columns[leading[0]]
        axes.set_title(named, loc="left", fontsize="small")
        axes.set_xlabel(leading[0], fontsize="small")
        if len(leading) == 1:
            axes.plot(x[picked], values[picked], ".", color=PALETTE[0], markersize=3)
            axes.set_ylabel(label, fontsize="small")
            continue
        y = columns[leading[1]]
        ends = [(each[chosen].min(), each[chosen].max()) for each in (x, y)]
        across = np.linspace(0, 1, 40)
        surface = _fit_quadratic(
            [_normalise(x[chosen], ends[0]), _normalise(y[chosen], ends[1])], values[chosen], across
        )
        limits = {"vmin": values[chosen].min(), "vmax": values[chosen].max()}
        extents = [low + across * (high - low) for low, high in ends]
        if surface is not None:
            axes.contourf(*extents, surface, 12, cmap=_COLOURS, alpha=0.6, **limits)
        dots = axes.scatter(
            x[picked], y[picked], c=values[picked], s=6, cmap=_COLOURS, edgecolors="none", **limits
        )
        axes.set_ylabel(leading[1], fontsize="small")
        figure.colorbar(dots, ax=axes, label=label)
    return figure


def _normalise(values: np.ndarray, ends: Tuple[float, float]) -> np.ndarray:
    return (values - ends[0]) / ((ends[1] - ends[0]) or 1.0)


def _terms(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=-1)


def _fit_quadratic(
    axes: Sequence[np.ndarray], values: np.ndarray, across: np.ndarray
) -> Optional[np.ndarray]:
    """Fit a quadratic function over the unit square; return None if there are too few rows."""
    terms = _terms(*axes)
    if len(terms) < 3 * terms.shape[1]:
        return None
    found, _, rank, _ = np.linalg.lstsq(terms, values, rcond=None)
    if rank < terms.shape[1]:
        return None
    surface: np.ndarray = _terms(*np.meshgrid(across, across)) @ found
    return surface


def _draw_parallel(
    parts: Parts, columns: Columns, axes_shown: Sequence[str], measure: str, label: str, note: str
) -> Figure:
    from matplotlib.collections import LineCollection

    names = [*axes_shown, measure]
    height = 3.0
    figure = make_figure(f"Parallel coordinates, coloured by {measure}{note}", 8, height)
    axes = figure.add_axes((0.05, 0.2, 0.78, 0.66))
    dress(axes)
    chosen = np.concatenate([part for _, part in parts])
    ends = {name: (columns[name][chosen].min(), columns[name][chosen].max()) for name in names}
    rows = chosen[pick_evenly(len(chosen), _LINES)]
    rows = rows[np.argsort(columns[measure][rows])]  # draw the highest values last
    heights = np.stack([_normalise(columns[name][rows], ends[name]) for name in names], axis=1)
    scale = _colour_scale(columns[measure][chosen])
    heights[:, -1] = scale(columns[measure][rows])
    places = np.broadcast_to(np.arange(len(names)), heights.shape)
    lines = LineCollection(
        list(np.stack([places, heights], axis=2)),
        array=columns[measure][rows],
        norm=scale,
        cmap=_COLOURS,
        linewidths=0.6,
        alpha=0.7,
    )
    axes.add_collection(lines)
    bar = figure.add_axes((0.87, 0.2, 0.02, 0.66))
    figure.colorbar(lines, cax=bar, label=label)
    axes.set_xlim(-0.1, len(names) - 0.9)
    axes.set_ylim(-0.05, 1.05)
    axes.set_yticks([])
    axes.set_xticks(range(len(names)))
    axes.set_xticklabels(
        [f"{name.split('.')[-1]}\n{ends[name][0]:.3g} to {ends[name][1]:.3g}" for name in names],
        fontsize="x-small",
        rotation=0 if len(names) < 6 else 30,
    )
    return figure


def _add_legend(figure: Figure, axes: Any, parts: Parts) -> None:
    if len(parts) > 1:
        figure.legend(
            *axes.get_legend_handles_labels(),
            loc="upper left",
            bbox_to_anchor=(0, 1 - 0.25 / figure.get_figheight()),
            ncol=2,
            frameon=False,
            fontsize="small",
        )
