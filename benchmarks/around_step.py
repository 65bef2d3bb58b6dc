"""What there is around a step: import, reading, construction, rows of a log, CSV."""

import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import thread_time_ns

import quadcore as qc
from quadcore.model import resources
from quadcore.model.description import load_description

STEPS = 20_000
BARS = {
    "import quadcore, with numpy, ms": 120,
    "a xacro that has not changed : expanded": 0.1,
    "a Simulation of a model already read, ms": 0.3,
    "a logged row over its step, us": 0.15,
    "the same with wrenches, us": None,
    "to_csv, us a row": 2,
}
IMPORT = """
from time import process_time
start = process_time()
import numpy
middle = process_time()
import quadcore
print(middle - start, process_time() - start)
"""


def cost(call, unit, clock=thread_time_ns):
    start = clock()
    call()
    return (clock() - start) / unit


def imported():
    done = subprocess.run(
        [sys.executable, "-c", IMPORT], stdout=subprocess.PIPE, text=True, check=True
    )
    return [1e3 * float(seconds) for seconds in done.stdout.split()]


def expansions(folder, rounds):
    """Pairs of times in which a xacro is read again, and for the first time."""
    text = (resources.find_root() / "urdf/quadrotor.urdf.xacro").read_text()

    def read(file):
        return cost(lambda: load_description(str(file), {}), 1)

    pairs = []
    for i in range(rounds):
        file = Path(folder) / f"{i}.xacro"
        file.write_text(text)
        first = read(file)
        pairs.append((read(file), first))
    return pairs


def construction(engine, rounds):
    model, world = qc.read_model("quadrotor"), qc.read_world()

    def make():
        qc.Simulation(model, world=world, engine=engine)

    return median(cost(make, 1e6) for _ in range(rounds))


def logged(sim, rounds, **options):
    """What a step takes longer when it is logged, us; in turns with steps that are not."""

    def fly(**options):
        sim.reset()
        sim.command([480, -480, 480, -480])
        return cost(lambda: sim.run(STEPS * sim.dt, **options), 1000 * STEPS)

    return median(fly(**options) - fly(log_every=STEPS) for _ in range(rounds))


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 21
    found = {}
    imports = [imported() for _ in range(rounds)]
    sim = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
    with tempfile.TemporaryDirectory() as folder:
        found["import quadcore, with numpy, ms"] = median(whole for _, whole in imports)
        found["the same : import numpy"] = median(whole / alone for alone, whole in imports)
        found["a xacro that has not changed : expanded"] = median(
            again / first for again, first in expansions(folder, rounds)
        )
        for engine, _ in qc.engines():
            what = f"a Simulation of a model already read, ms, {engine}"
            found[what] = construction(engine, 10 * rounds)
        found["a logged row over its step, us"] = logged(sim, rounds)
        found["the same with wrenches, us"] = logged(sim, rounds, wrenches=True)
        sim.reset()
        log = sim.run(STEPS * sim.dt)
        file = Path(folder) / "log.csv"
        found["to_csv, us a row"] = median(
            cost(lambda: log.to_csv(file), 1000 * STEPS) for _ in range(rounds)
        )
    for what, measured in found.items():
        bar = next((bar for name, bar in BARS.items() if what.startswith(name)), None)
        print(f"{what:52s} {measured:8.3f}" + (f"   at most {bar}" if bar else ""))


main()
