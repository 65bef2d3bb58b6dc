"""Plots of the causes of the difference between the plant and the model."""

from __future__ import annotations

import textwrap
from typing import Any, Dict, List, Sequence, Tuple

import numpy as np

from ...report.colours import PALETTE
from ...report.drawing import Drawing
from ...report.plots import dress, finish, make_figure
from .damping import Damping
from .error_budget import Chain, Link
from .output import size

_DPI = 100
_NO_DECAY = 1e-9  # 1/s
_NO_DISTANCE = 1e-9  # m; smaller differences are rounding errors
_COMMON = "0.55"  # colour of a link that several chains share


def draw_chains(chains: Sequence[Chain]) -> Drawing:
    """Draw the effect of each link in the chains of one drag."""
    groups = _list_bars(chains)
    bars = sum(len(group) for group in groups.values())
    height = 0.9 + 0.19 * (bars + len(groups))
    figure = make_figure(f"Effect of each change, drag: {chains[0].drag}", 9, height, _DPI)
    axes = figure.add_axes((0.36, 0.55 / height, 0.61, 1 - 1.0 / height))
    dress(axes)
    largest = [link.max for group in groups.values() for _, link in group]
    low, high = _find_range(largest)
    ticks, top = [], 0
    named: Dict[str, Any] = {}
    for group in groups.values():
        for row, (whose, link) in enumerate(group, start=top):
            shown = max(link.max, low)
            colour = _choose_colour(whose, chains)
            (bar,) = axes.barh(row, shown - low, 0.85, left=low, color=colour)
            axes.text(shown, row, f" {size(link.max)} m", va="center", fontsize="small")
            named.setdefault(whose, bar)
        ticks.append(top + (len(group) - 1) / 2)
        top += len(group) + 1
    axes.set_xscale("log")
    axes.set_xlim(low, high)
    axes.set_ylim(top - 1.2, -0.8)
    axes.set_yticks(ticks)
    axes.set_yticklabels([textwrap.fill(change, 46) for change in groups], fontsize="small")
    axes.tick_params(axis="y", length=0)
    axes.grid(False, axis="y")
    axes.set_xlabel("maximum distance between the two flights (m)")
    figure.legend(
        list(named.values()),
        list(named),
        loc="upper right",
        ncol=len(named),
        frameon=False,
        fontsize="small",
        handlelength=1.0,
        columnspacing=1.0,
    )
    return finish(figure)


def _list_bars(chains: Sequence[Chain]) -> Dict[str, List[Tuple[str, Link]]]:
    """Group the links by their change; each has the label of its chain, or of all chains."""
    owners: Dict[Tuple[Any, Any], List[Chain]] = {}
    for chain in chains:
        for link in chain.links:
            owners.setdefault((link.begin, link.end), []).append(chain)
    order = max((chain.links for chain in chains), key=len)
    groups: Dict[str, List[Tuple[str, Link]]] = {link.change: [] for link in order}
    for chain in chains:
        for link in chain.links:
            sharing = owners[link.begin, link.end]
            if chain is sharing[0]:
                whose = f"sim_slow {chain.sim_slow:g}" if len(sharing) == 1 else "all of them"
                groups.setdefault(link.change, []).append((whose, link))
    return groups


def _find_range(values: Sequence[float]) -> Tuple[float, float]:
    """Return the limits of a logarithmic axis for bars and their labels."""
    low = max(min(values), _NO_DISTANCE) / 3
    span = max(np.log10(max(values) / low), 1.0)
    return low, low * 10 ** (1.2 * span)


def _choose_colour(name: str, chains: Sequence[Chain]) -> str:
    names = [f"sim_slow {chain.sim_slow:g}" for chain in chains]
    return PALETTE[names.index(name) % len(PALETTE)] if name in names else _COMMON


def draw_damping(damping: Sequence[Damping]) -> Drawing:
    """Draw the decay of a pitch rate without torque."""
    figure = make_figure("Decay of a pitch rate in free fall, without air", 6.4, 3.4, _DPI)
    axes = figure.add_axes((0.12, 0.16, 0.85, 0.72))
    dress(axes)
    damping = sorted(damping, key=lambda entry: entry.sim_slow)
    slow = [entry.sim_slow for entry in damping]
    label = r"explicit torque: $\sum (I_{zz}-I_{xx}) W^2 \Delta t\,/\,2J$"
    formula = [entry.formula for entry in damping]
    axes.plot(slow, formula, color="0.5", linewidth=1, label=label)
    engines = dict.fromkeys(engine for entry in damping for engine in entry.measured)
    for engine, colour, mark in zip(engines, PALETTE, "osD"):
        decays = {n: abs(entry.measured.get(engine, 0)) for n, entry in zip(slow, damping)}
        shown = {n: decay for n, decay in decays.items() if decay > _NO_DECAY}
        name = engine if shown else f"{engine}: below {_NO_DECAY:g}"
        axes.plot(list(shown), list(shown.values()), mark, color=colour, label=name)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xticks(slow)
    axes.set_xticklabels([f"{n:g}" for n in slow])
    axes.minorticks_off()
    axes.margins(x=0.04)
    axes.set_ylim(_NO_DECAY, 3 * max(formula))
    axes.set_xlabel("sim_slow")
    axes.set_ylabel("decay (1/s)")
    axes.legend(loc="lower left", frameon=False, fontsize="small")
    return finish(figure)
