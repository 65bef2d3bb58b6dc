"""Pictures of a sweep."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from ...report.colours import PALETTE
from ...report.plots import dress, make_figure, panels, png
from ...report.thinning import pick_evenly
from .plan import AnyPlan
from .sensitivity import COMBINATION, axes_of_numbers, combinations

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NAMES = ("measure", "sensitivity", "surface", "parallel")

_COMBINATIONS = 4  # that are drawn
_AXES = 12
_LINES = 600
_WIDE = 30  # times the least, from which on a logarithm shows more
_SCALE = "viridis"

Columns = Mapping[str, np.ndarray]


def draw(
    plan: AnyPlan, columns: Columns, sensitivities: Sequence[Mapping[str, Any]], measure: str
) -> Dict[str, bytes]:
    """Draw how a measure is spread, and what it depends on: PNG by name.

    Parameters
    ----------
    plan, columns, sensitivities
        What was flown, what came of it, and what that is sensitive to.
    measure
        The one that is drawn.
    """
    found = list(combinations(columns))
    parts = [
        (
            _label(names, [other for other, _ in found]),
            chosen[np.isfinite(columns[measure][chosen])],
        )
        for names, chosen in found
    ]
    parts = [part for part in parts if len(part[1]) > 1][:_COMBINATIONS]
    if not parts:
        return {}
    label = f"{measure} ({plan.units[measure]})" if plan.units[measure] else measure
    rows = {_label(names, [other for other, _ in found]): len(at) for names, at in found}
    figures: Dict[str, Figure] = {"measure": _spread(parts, rows, columns[measure], label)}
    axes = axes_of_numbers(plan, columns)[:_AXES]
    told = [row for row in sensitivities if row["measure"] == measure and row["axis"] in axes]
    if told:
        figures["sensitivity"] = _sensitivity(told, measure)
        figures["surface"] = _surface(parts, columns, _leading(told), measure, label)
    if len(axes) > 1:
        figures["parallel"] = _parallel(parts, columns, axes, measure, label)
    return {name: png(figure) for name, figure in figures.items()}


Parts = List[Tuple[str, np.ndarray]]


def _label(names: Mapping[str, str], among: Sequence[Mapping[str, str]]) -> str:
    """Name a combination by what sets it apart from the others."""
    return ", ".join(v for k, v in names.items() if len({other[k] for other in among}) > 1)


def _scaled(values: np.ndarray) -> np.ndarray:
    """Take the logarithm of what spans magnitudes, where colours are concerned."""
    is_wide = values.min() > 0 and values.max() > _WIDE * values.min()
    return np.log(values) if is_wide else values


def _spread(parts: Parts, rows: Mapping[str, int], values: np.ndarray, label: str) -> Figure:
    """Draw shares of all rows; one that failed stays below nothing."""
    figure, grid = panels("Which share of the rows stays below", 1, height=2.8, above=0.7)
    axes = grid[0, 0]
    for i, (named, chosen) in enumerate(parts):
        found = np.sort(values[chosen])
        share = np.arange(1, 1 + len(found)) / rows[named]
        axes.step(found, share, where="post", label=named, color=PALETTE[i])
    if values[np.concatenate([chosen for _, chosen in parts])].min() > 0:
        axes.set_xscale("log")
    axes.set_xlabel(label)
    axes.set_ylim(0, 1)
    _legend(figure, axes, parts)
    return figure


def _sensitivity(told: Sequence[Mapping[str, Any]], measure: str) -> Figure:
    is_sobol = any(np.isfinite(row["total"]) for row in told)
    what = "Sobol indices" if is_sobol else "Rank correlations"
    height = 1.1 + 0.3 * len(told)
    figure = make_figure(f"{what} of {measure}", 8, height)
    axes = figure.add_axes((0.45, 0.5 / height, 0.52, 1 - 1.0 / height))
    dress(axes)
    places = np.arange(len(told))[::-1]
    if is_sobol:
        for name, shift, colour in (("first", 0.2, PALETTE[0]), ("total", -0.2, PALETTE[1])):
            widths = [row[name] for row in told]
            ends = [row[f"{name}_interval"] for row in told]
            axes.barh(
                places + shift, widths, xerr=ends, height=0.36, color=colour, label=name, capsize=2
            )
        axes.legend(frameon=False, fontsize="small")
    else:
        axes.barh(places, [row["rank"] for row in told], height=0.6, color=PALETTE[0])
        axes.set_xlim(-1, 1)
    axes.axvline(0, color="black", linewidth=0.8)
    axes.set_yticks(places)
    named = [{name: row[name] for name in COMBINATION if name in row} for row in told]
    labels = [(_label(names, named), row["axis"]) for names, row in zip(named, told)]
    axes.set_yticklabels([": ".join(filter(None, each)) for each in labels], fontsize="small")
    return figure


def _leading(told: Sequence[Mapping[str, Any]]) -> List[str]:
    """Name the two axes that matter most."""
    weight: Dict[str, float] = {}
    for row in told:
        size = row["total"] if np.isfinite(row["total"]) else abs(row["rank"])
        weight[row["axis"]] = max(weight.get(row["axis"], 0.0), float(np.nan_to_num(size)))
    return sorted(weight, key=lambda axis: -weight[axis])[:2]


def _surface(
    parts: Parts, columns: Columns, leading: Sequence[str], measure: str, label: str
) -> Figure:
    height = 3.2
    figure = make_figure("Response surface: rows, and the quadratic through them", 8, height)
    grid = figure.subplots(
        1,
        len(parts),
        squeeze=False,
        gridspec_kw={"left": 0.1, "right": 0.95, "top": 0.82, "bottom": 0.2, "wspace": 0.45},
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
        surface = _quadratic(
            [_unit(x[chosen], ends[0]), _unit(y[chosen], ends[1])], values[chosen], across
        )
        limits = {"vmin": values[chosen].min(), "vmax": values[chosen].max()}
        extents = [low + across * (high - low) for low, high in ends]
        if surface is not None:
            axes.contourf(*extents, surface, 12, cmap=_SCALE, alpha=0.6, **limits)
        dots = axes.scatter(
            x[picked], y[picked], c=values[picked], s=6, cmap=_SCALE, edgecolors="none", **limits
        )
        axes.set_ylabel(leading[1], fontsize="small")
        figure.colorbar(dots, ax=axes, label=label)
    return figure


def _unit(values: np.ndarray, ends: Tuple[float, float]) -> np.ndarray:
    return (values - ends[0]) / ((ends[1] - ends[0]) or 1.0)


def _terms(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=-1)


def _quadratic(
    axes: Sequence[np.ndarray], values: np.ndarray, across: np.ndarray
) -> Optional[np.ndarray]:
    """Least squares over the unit square; None if the rows are too few."""
    terms = _terms(*axes)
    if len(terms) < 3 * terms.shape[1]:
        return None
    found, _, rank, _ = np.linalg.lstsq(terms, values, rcond=None)
    if rank < terms.shape[1]:
        return None
    surface: np.ndarray = _terms(*np.meshgrid(across, across)) @ found
    return surface


def _parallel(
    parts: Parts, columns: Columns, axes_shown: Sequence[str], measure: str, label: str
) -> Figure:
    from matplotlib.collections import LineCollection

    names = [*axes_shown, measure]
    height = 3.0
    figure = make_figure(f"Parallel coordinates, coloured by {measure}", 8, height)
    axes = figure.add_axes((0.07, 0.2, 0.84, 0.66))
    dress(axes)
    chosen = np.concatenate([rows for _, rows in parts])
    ends = {name: (columns[name][chosen].min(), columns[name][chosen].max()) for name in names}
    picked = chosen[pick_evenly(len(chosen), _LINES)]
    picked = picked[np.argsort(columns[measure][picked])]  # the largest on top
    heights = np.stack([_unit(columns[name][picked], ends[name]) for name in names], axis=1)
    shades = _scaled(columns[measure][picked])
    heights[:, -1] = _unit(shades, (shades.min(), shades.max()))
    places = np.broadcast_to(np.arange(len(names)), heights.shape)
    lines = LineCollection(
        list(np.stack([places, heights], axis=2)),
        array=heights[:, -1],
        cmap=_SCALE,
        linewidths=0.6,
        alpha=0.7,
    )
    axes.add_collection(lines)
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


def _legend(figure: Figure, axes: Any, parts: Parts) -> None:
    if len(parts) > 1:
        figure.legend(
            *axes.get_legend_handles_labels(),
            loc="upper left",
            bbox_to_anchor=(0, 1 - 0.25 / figure.get_figheight()),
            ncol=2,
            frameon=False,
            fontsize="small",
        )
