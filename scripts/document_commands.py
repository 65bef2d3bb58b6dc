#!/usr/bin/env python3
"""Write docs/commands/NAME.md, a page for each command of quadcore with an example and its output.

``scripts/document`` runs it; the tests run the examples and compare the output.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from quadcore.cli import make_parser

PAGES = Path(__file__).resolve().parents[1] / "docs" / "commands"
SPIRAL = "--controller geometric --reference spiral --engine eigen --xacro sim_slow:=1"
FLIGHT = f"quadcore run quadrotor {SPIRAL} --out out/spiral --quiet"
HEAVIER = (
    "quadcore run quadrotor --set frame.mass=1.1 --controller geometric --reference circle \\\n"
)
HEAVIER += "  --engine eigen --duration 4 --log flight.csv --quiet"


class Example(NamedTuple):
    """The example of a command's page."""

    shell: str
    text: str
    """What the example does, and the page on the task."""
    before: str = ""
    """Commands that make the files which the example reads."""
    lines: int = 30
    """Lines of output to show; 0 if there are none, or if they differ from run to run."""
    tolerance: float = 0.0
    """Relative difference of the numbers between versions of numpy and scipy."""


EXAMPLES = {
    "info": Example(
        "quadcore info crazyflie",
        "Without MODEL, it lists the built-in models. See [write a model](../models.md).",
        lines=24,
    ),
    "run": Example(
        f"quadcore run quadrotor {SPIRAL} --out out/spiral",
        "It writes a log, plots and a page into the folder of `--out`. See "
        "[controllers and references](../control.md).",
    ),
    "validate": Example(
        "quadcore validate --sim-slow 1 --drag none --duration 2 --out out/validation",
        "See [validation](../validation.md) for the experiments of the thesis.",
    ),
    "compare": Example(
        "quadcore compare quadrotor --vary engine=gazebo11,eigen --controller geometric \\\n"
        "  --reference circle --duration 5 --out out/engines",
        "See [compare models and parameters](../comparing.md).",
    ),
    "evaluate": Example(
        "quadcore evaluate --controller pd,geometric --reference spiral,circle --duration 10 \\\n"
        "  --out out/controllers",
        "See [evaluate controllers](../evaluate.md).",
    ),
    "benchmark": Example(
        "quadcore benchmark --controller geometric,lqr --vehicle crazyflie --category slow \\\n"
        "  --out out/part",
        "Without `--vehicle` and `--category`, it runs the whole benchmark. See "
        "[the benchmark](../benchmark.md).",
    ),
    "measure": Example(
        "quadcore measure pd=flight.bag --reference circle --controller pd,geometric \\\n"
        "  --xacro sim_slow:=1 --out out/measured",
        "The bag is that of a simulated flight, so that both rows of `pd` agree. See "
        "[measure recorded flights](../measure.md).",
        before="QUADCORE_SHORT=no quadcore run quadrotor --engine eigen --xacro sim_slow:=1 \\\n"
        "  --controller pd --reference circle --duration 10 --log-every 10 \\\n"
        "  --log flight.bag --quiet",
    ),
    "sweep": Example(
        "quadcore sweep --controller geometric --reference circle \\\n"
        "  --vary frame.mass=uniform:0.9:1.1 --samples 20 --duration 5 --out out/mass",
        "See [sweep parameters](../sweep.md).",
    ),
    "play": Example(
        "quadcore play out/spiral/log.csv --model quadrotor -o flight.html",
        "Open the page in a browser. See [watch flights](../play.md).",
        before=FLIGHT,
    ),
    "plot": Example(
        "quadcore plot out/spiral/log.csv --out out/plots",
        "See [watch flights](../play.md).",
        before=FLIGHT,
    ),
    "tune": Example(
        "quadcore tune pd --reference step --hold-out circle --only kp_xy,kd_xy --duration 3 \\\n"
        "  --budget 12 -o gains.yaml",
        "See [tune gains](../tune.md).",
        tolerance=0.02,
    ),
    "fit": Example(
        "quadcore fit quadrotor --log flight.csv --free frame.mass -o fitted.urdf",
        "The frame of the logged vehicle has 1.1 kg, and that of the model 1 kg. "
        "See [fit a model](../fit.md).",
        before=f"QUADCORE_SHORT=no {HEAVIER}",
        tolerance=0.02,
    ),
    "predict": Example(
        "quadcore predict crazyflie --log flight.csv --out out/prediction",
        "Here the log comes from the same model, so only the errors of the time steps remain. "
        "See [fit a model](../fit.md#recordings-of-real-flights).",
        before="QUADCORE_SHORT=no quadcore run crazyflie --controller geometric --reference eight "
        "--engine eigen \\\n  --duration 12 --log-every 10 --log flight.csv --quiet",
        tolerance=0.02,
    ),
    "convert": Example(
        "quadcore convert flight.csv flight.mat",
        "See [file formats](../formats.md).",
        before=HEAVIER,
        lines=0,
    ),
    "serve": Example(
        "quadcore serve quadrotor --port 5555 --log flight.csv",
        "It prints `serving 127.0.0.1:5555` and waits for a client. See [serve](../serve.md).",
        lines=0,
    ),
    "autopilot": Example(
        "quadcore autopilot list",
        "`quadcore autopilot check betaflight.yaml --model iris` checks a stack on a bench. "
        "See [autopilots](../autopilots.md).",
    ),
    "export-fmu": Example(
        "quadcore export-fmu quadrotor --engine eigen -o quadrotor.fmu",
        "See [export an FMU](../fmu.md).",
    ),
    "list": Example("quadcore list engines", "Use it in scripts together with `--json`."),
    "doctor": Example(
        "quadcore doctor || true",
        "It reports versions, missing optional packages and mixed installations, each with its "
        "remedy. See [troubleshooting](../troubleshooting.md).",
        lines=0,
    ),
    "examples": Example(
        "quadcore examples quadcore_examples",
        "Nothing is overwritten. See [notebooks](../notebooks.md).",
    ),
    "completion": Example(
        "quadcore completion bash >quadcore_completion.bash",
        "`quadcore completion SHELL --help` names the file for each shell.",
        lines=0,
    ),
}


def run_example(example: Example) -> str:
    """Run an example in a folder of its own; returns its output, without what varies."""
    with tempfile.TemporaryDirectory() as folder:
        quadcore = f'quadcore() {{ "{sys.executable}" -m quadcore "$@"; }}\n'
        if example.before:
            subprocess.run(["bash", "-ec", quadcore + example.before], cwd=folder, check=True)
        done = subprocess.run(
            ["bash", "-ec", quadcore + example.shell],
            cwd=folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=True,
        )
    lines = [
        re.sub(r"[\d,.]+ per s\b", "... per s", line).rstrip() for line in done.stdout.split("\n")
    ]
    while lines and not lines[-1]:
        lines.pop()
    cut = lines[: example.lines] + ["..."] * (len(lines) > example.lines)
    return "\n".join(cut)


def write_page(name: str, parser: argparse.ArgumentParser, example: Example) -> str:
    """Write the page of a command."""
    parts = [
        "<!-- Written by scripts/document: change scripts/document_commands.py, not this file. -->",
        f"# quadcore {name}",
        f"{parser.description} {example.text}",
    ]
    parts += [f"<!-- run: {line} -->" for line in example.before.replace("\\\n", "").splitlines()]
    parts.append(f"```sh\n{example.shell}\n```")
    if example.lines:
        tolerance = f": {example.tolerance:g}" if example.tolerance else ""
        parts.append(f"<!-- output{tolerance} -->\n```text\n{run_example(example)}\n```")
    directive = (
        ".. argparse::\n   :module: quadcore.cli\n   :func: make_parser\n   :prog: quadcore\n"
    )
    directive += f"   :path: {name}\n   :nodescription:\n   :noepilog:"
    parts += ["## Options", f"```{{eval-rst}}\n{directive}\n```"]
    return "\n\n".join(parts) + "\n"


def main() -> None:
    """Write all pages, or those of the commands that are named."""
    choices = make_parser()._subparsers._group_actions[0].choices  # type: ignore[union-attr]
    assert set(choices) == set(EXAMPLES), set(choices) ^ set(EXAMPLES)
    for name in sys.argv[1:] or choices:
        (PAGES / f"{name}.md").write_text(write_page(name, choices[name], EXAMPLES[name]))
        print(f"docs/commands/{name}.md")


if __name__ == "__main__":
    main()
