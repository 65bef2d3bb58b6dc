#!/usr/bin/env python3
"""Write the figures and tables of docs/validation.md: ``scripts/document`` runs it."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import Any, Iterator

import numpy as np
from images import save
from measured import DOCS, figures, put

from quadcore.report.colours import PALETTE
from quadcore.report.plots import dress, make_figure, png
from quadcore.thesis.validation import Case, Experiment, Study, run_study
from quadcore.thesis.validation.experiment import NO_LAG
from quadcore.thesis.validation.figures import list_figures
from quadcore.thesis.validation.output import size
from quadcore.thesis.validation.thesis_figures import KINDS, thesis_figures

FROM_THE_COMMAND = {"position": "position_all", "error": "error_all", "chain": "chain_all"}


def draw_gains() -> bytes:
    """Draw how the outer loop of table 6.2 corrects an error on an ideal double integrator."""
    figure = make_figure(
        "Outer loop of table 6.2 in x and y, ideal plant: error from 2 m", 7, 2.8, 100
    )
    axes = figure.add_axes((0.09, 0.17, 0.89, 0.68))
    dress(axes)
    time = np.linspace(0, 20, 500)
    for Kd, colour, label in (
        (0.125, PALETTE[1], "$K_D$ 0.125, as published"),
        (2.5, PALETTE[0], "$K_D$ 2.5"),
    ):
        roots = np.roots([1, Kd, 2.4, 0.8])
        # e = 2 m, at rest, integral empty: e, edot, eddot = -Kp e at t = 0.
        shares = np.linalg.solve(np.vander(roots, 3, increasing=True).T, [2, 0, -2.4 * 2])
        error = (shares * np.exp(np.outer(time, roots))).sum(axis=1).real
        axes.plot(time, error, color=colour, label=label)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("error (m)")
    axes.legend(loc="upper left", frameon=False, ncol=2, fontsize="small")
    axes.set_ylim(-14, 18)
    return png(figure)


def distances(study: Study) -> Iterator[Any]:
    """Tabulate the maximum distance of every engine from the model."""
    rows = {row.case: row.difference for row in study.rows}
    for engine in study.engines:
        for slow in study.sim_slow:
            found = [rows[Case(engine, slow, drag)] for drag in study.drags]
            yield engine, f"{slow:g}", *(size(one.max["distance"]) for one in found if one)


def shares(study: Study) -> Iterator[Any]:
    """Tabulate the chains with all drags side by side."""
    chains = [chain for chain in study.chains if chain.drag == "all"]
    changes = max((chain.links for chain in chains), key=len)
    for change in (link.change for link in changes):
        links = [{link.change: link for link in chain.links}.get(change) for chain in chains]
        largest = list(dict.fromkeys(size(link.max) for link in links if link))
        yield change, *(size(link.share) if link else "" for link in links), ", ".join(largest)
    yield "sum: distance from the model", *(size(chain.distance) for chain in chains), ""


def numbers(study: Study) -> Iterator[Any]:
    """Tabulate the figures of the thesis that correspond to the plots."""
    for drag in study.drags:
        found = [thesis_figures(drag, kind, study.sim_slow) for kind in KINDS]
        if any(found):
            yield f"`{drag}`", *found


def decays(study: Study) -> Iterator[Any]:
    """Tabulate the artificial damper."""
    for entry in study.damping:
        found = [abs(entry.measured[engine]) for engine in study.engines]
        shown = [size(one) if one > 1e-9 else "below 1e-9" for one in found]
        yield f"{entry.sim_slow:g}", size(entry.formula), *shown


def hover(experiment: Experiment) -> float:
    """Return the rotor speed at the start of the flights (rad/s)."""
    return float(np.abs(experiment.commands[0, 1:]).mean())


def slowed(study: Study) -> Iterator[Any]:
    """Tabulate the effect of the slowdown alone."""
    for drag in ("none", "all"):
        for row in study.slowed:
            if row.case.drag == drag and row.difference:
                apart = row.difference.max
                yaw = f"{np.degrees(apart['psi']):.3g}"
                yield f"{row.case.sim_slow:g}", drag, size(apart["distance"]), yaw


def steps() -> Iterator[Any]:
    """Tabulate the effect of ODE's step with all drags, at several slowdowns."""
    for dt in (1e-3, 5e-4, 2.5e-4, 1.25e-4):
        experiment = Experiment.of(dt=dt, log_every=round(1e-2 / dt))
        found = []
        for engine, slow in (("ode", 1.0), ("ode", 8.0), ("ode", 18.0), ("gazebo11", 1.0)):
            logs = [experiment.fly(Case(one, slow)).log for one in (engine, "eigen")]
            apart = logs[0].position - logs[1].position  # type: ignore[union-attr]
            found.append(size(float(np.linalg.norm(apart, axis=1).max())))
        yield f"{figures(dt * 1e3, 3)} ms", *found


# Terms that chapter 2 omits, and their place in the thesis.
LEFT_OUT = {
    NO_LAG: (
        "lag of the motors, $`I_R\\dot\\omega_i = k_p(u_i-\\omega_i)`$",
        "none; the model here has it (`--motors lag`)",
    ),
    "the torque of rotors that spin up": (
        "torque of rotors that spin up, $`-\\sum I_R\\dot\\omega_i\\,a_i`$",
        "in (2.11), dropped after (2.13)",
    ),
    "rotors that do not turn with the frame": (
        "rotors that do not turn with the frame, $`\\dot\\omega_i = \\dots - a_i\\cdot\\dot\\nu`$",
        "none",
    ),
}


def left_out(study: Study) -> Iterator[Any]:
    """Tabulate the effect of the terms that chapter 2 omits."""
    rows = {row.case.variant: row.difference for row in study.left_out}
    for variant, texts in LEFT_OUT.items():
        difference = rows[variant]
        yield *texts, size(difference.max["distance"]) if difference else "failed"


def hexarotor() -> Iterator[Any]:
    """Simulate the hexarotor of docs/models.md with all drags."""
    text = re.findall(r"```xml\n(<\?xml.*?)```", (DOCS / "models.md").read_text(), re.DOTALL)[0]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "hexarotor.urdf.xacro"
        file.write_text(text)
        study = run_study(Experiment.of(str(file)), drags=["all"])
    rows = {row.case: row.difference for row in study.rows}
    for engine in study.engines:
        found = [rows[Case(engine, slow, "all")] for slow in study.sim_slow]
        yield engine, *(size(one.max["distance"]) if one else "failed" for one in found)


def write_tables(study: Study) -> None:
    """Write the tables between marks."""
    slow = [f"{n:g}" for n in study.sim_slow]
    page = "validation.md"
    put(page, "distances", ("engine", "sim_slow", *study.drags), distances(study))
    heading = ("change", f"from sim_slow {slow[0]}", *(f"from {n}" for n in slow[1:]))
    put(page, "shares", (*heading, "maximum"), shares(study))
    titles = [kind.title.lower() for kind in KINDS.values()]
    put(page, "figures", ("drag", *titles), numbers(study))
    engines = [f"`{engine}`" for engine in study.engines]
    formula = f"formula, {hover(study.experiment):.4g} rad/s / sim_slow"
    put(page, "decays", ("sim_slow", formula, *engines), decays(study))
    put(page, "slowed", ("sim_slow", "drag", "distance (m)", "yaw (degrees)"), slowed(study))
    heading = ("term", "in the thesis", "moves the model by (m)")
    put(page, "left out", heading, left_out(study))
    put(page, "hexarotor", ("engine", f"sim_slow {slow[0]}", *slow[1:]), hexarotor())
    heading = ("step", "`ode`, sim_slow 1", "8", "18", "`gazebo11`, sim_slow 1")
    put(page, "steps", heading, steps())


def main() -> None:
    """Run the experiment of ``quadcore validate``; write tables and figures."""
    study = run_study(Experiment.of())
    write_tables(study)
    drawn = {"gains": draw_gains()}
    wanted = list_figures(study)
    for name, picture in {**FROM_THE_COMMAND, "commands": "commands", "damping": "damping"}.items():
        function, arguments = wanted[picture]
        drawn[name] = function(*arguments).files["png"]
    for name, data in drawn.items():
        save(f"validation_{name}", data)


if __name__ == "__main__":
    main()
