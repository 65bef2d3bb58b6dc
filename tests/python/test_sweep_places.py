"""A sweep gives the same table wherever it is flown."""

from __future__ import annotations

import concurrent.futures
import json
import logging
import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import pytest
from processes import LONG, script
from sweeps import lines, sweep

import quadcore as qc
from quadcore.studies.sweep.row_spec import Flight

pytestmark = pytest.mark.usefixtures("in_empty_folder")

MANY = {"samples": 300, "duration": 1.0}


def test_any_executor_of_futures_gives_the_same_table():
    sweep(out="here")
    with concurrent.futures.ProcessPoolExecutor(2) as processes:
        sweep(out="processes", executor=processes)
    with concurrent.futures.ThreadPoolExecutor(2) as threads:
        sweep(out="threads", executor=threads)
    assert lines("here") == lines("processes") == lines("threads")


def test_the_time_limit_holds_in_threads_too():
    with concurrent.futures.ThreadPoolExecutor(1) as threads:
        found = sweep(duration=1000.0, samples=2, executor=threads, time_limit=0.3)
    assert set(found.columns["failure"]) == {"not done within the time limit of 0.3 s"}


def test_controllers_of_ones_own_have_processes_of_their_own_in_an_executor():
    """One that remembers would fly every row otherwise than the first."""
    Path("memory.py").write_text(
        "flown = []\ndef law(t, state, reference):\n"
        "    flown.append(t)\n    return [480 + len(flown) * 1e-3] * 4\n"
    )
    options = {"vary": {"frame.mass": [1.0, 1.0 + 1e-9, 1.0 + 2e-9]}, "duration": 0.1}
    here = qc.sweep("memory:law", "hover", **options)
    with concurrent.futures.ThreadPoolExecutor(1) as threads:
        there = qc.sweep("memory:law", "hover", executor=threads, **options)
    assert here.columns["rms_position"].tolist() == there.columns["rms_position"].tolist()
    assert here.columns["rms_position"] == pytest.approx(here.columns["rms_position"][0], rel=1e-6)


def test_an_executor_that_breaks_is_one_line_and_its_rows_stay():
    with concurrent.futures.ProcessPoolExecutor(1) as processes:

        def fell(done, _):
            if done == 2:
                for pid in processes._processes:
                    os.kill(pid, signal.SIGKILL)

        with pytest.raises(qc.QuadcoreError, match=r"the executor failed \(BrokenProcessPool"):
            sweep(out="out", executor=processes, progress=fell, samples=200)
    assert 3 <= len(lines("out")) < 200
    sweep(out="out", resume=True, samples=200)
    assert len(lines("out")) == 201


class Long:
    """A function whose pickle is longer than what fits into a pipe."""

    def __init__(self):
        self.ballast = b"x" * 10**6

    def __call__(self, point):
        return point["a"]


BROKEN = """
import concurrent.futures, os, signal
import quadcore as qc
from test_sweep_places import Long

processes = concurrent.futures.ProcessPoolExecutor(1)
with processes:
    def fell(done, _):
        if done == 1:
            for pid in processes._processes:
                os.kill(pid, signal.SIGKILL)
    try:
        qc.sweep(function=Long(), vary={"a": list(range(40))}, executor=processes, progress=fell)
    except qc.QuadcoreError as error:
        print(error)
"""


def test_an_executor_that_breaks_under_a_full_pipe_does_not_hang():
    paths = [str(Path(__file__).parent), *filter(None, [os.environ.get("PYTHONPATH")])]
    ran = subprocess.run(
        [sys.executable, "-c", BROKEN],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(paths)},
        stdout=subprocess.PIPE,
        text=True,
        timeout=120,
    )
    assert ran.returncode == 0 and "the executor failed (BrokenProcessPool" in ran.stdout


def test_a_pool_is_given_few_tasks_at_a_time():
    class Counting(concurrent.futures.ThreadPoolExecutor):
        under_way = most = 0

        def submit(self, *task):
            self.under_way += 1
            self.most = max(self.most, self.under_way)
            return super().submit(*task)

    with Counting(2) as threads:

        def end_worker(*_):
            threads.under_way -= 1

        qc.sweep(
            function=lambda point: point["a"],
            vary={"a": list(range(50))},
            executor=threads,
            progress=end_worker,
        )
    assert threads.most <= 5


def test_models_travel_as_documents():
    """What a row is pickled to flies where neither model nor gains, commands or world lie."""
    here = Path("here")
    here.mkdir()
    shipped = Path(qc.__file__).parent
    (here / "mine.urdf").write_text(qc.read_model("crazyflie").document.text)
    shutil.copy(shipped / "worlds/empty.world", here / "mine.world")
    (here / "gains.yaml").write_text("law: pd\n")
    from quadcore.studies.design import Design
    from quadcore.studies.options import SweepOptions
    from quadcore.studies.sweep.plan import Plan

    plan = Plan(
        Design({"world": [str(here / "mine.world")]}),
        [str(here / "gains.yaml")],
        "hover",
        ["eigen"],
        [str(here / "mine.urdf")],
        SweepOptions(duration=0.1),
    )
    spec = plan.make_spec(0)
    assert isinstance(spec, Flight)
    import pickle

    Path("spec.pickle").write_bytes(pickle.dumps(spec))
    expected = dict(spec.measure())
    shutil.rmtree("here")
    flown = script(
        "import pickle\nspec = pickle.load(open('spec.pickle', 'rb'))\n"
        "print(spec.fingerprint(), repr(spec.measure()['rms_position']))"
    )
    assert flown.stdout.split() == [spec.fingerprint(), repr(expected["rms_position"])]


# Dask


@contextmanager
def end_worker(processes):
    try:
        yield processes
    finally:
        for process in processes:
            process.kill()
            process.wait()


def dask(name, *arguments):
    words = [sys.executable, "-m", f"distributed.cli.dask_{name}", *arguments]
    with open(f"{name}.log", "a") as log:
        return subprocess.Popen([*words, "--no-dashboard"], stdout=log, stderr=log)


def worker(address):
    return dask("worker", address, "--nthreads", "1", "--no-nanny", "--memory-limit", "0")


@contextmanager
def cluster(workers):
    """A scheduler and workers as processes of this machine."""
    pytest.importorskip("distributed")
    started = [dask("scheduler", "--port", "0", "--scheduler-file", "at.json")]
    with end_worker(started):
        until = time.monotonic() + LONG
        while not Path("at.json").exists() and time.monotonic() < until:
            time.sleep(0.05)
        address = json.loads(Path("at.json").read_text())["address"]
        started += [worker(address) for _ in range(workers)]
        yield address, started


def test_a_cluster_may_lose_workers_gain_some_and_be_lost_itself():
    """The same table; of the lost one the rows so far, and one line."""
    sweep(out="here", processes=1, **MANY)
    words = ["sweep", "--controller=geometric", "--reference=circle", "--xacro=sim_slow:=1"]
    words += ["--vary=frame.mass=uniform:0.9:1.1", "--samples=300", "--duration=1", "--no-plots"]
    with cluster(3) as (address, started):

        def happens(done, _):
            if done == 10:
                started[1].send_signal(signal.SIGKILL)
            if done == 20:
                started.append(worker(address))

        sweep(out="there", dask=address, progress=happens, **MANY)
        assert lines("here") == lines("there")
        sweeping = subprocess.Popen(
            [sys.executable, "-m", "quadcore", *words, "--out=out", "--dask", address],
            stderr=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            text=True,
        )
        with end_worker([sweeping]):
            until = time.monotonic() + LONG
            while not (Path("out/table.csv").exists() and len(lines("out")) > 5):
                assert time.monotonic() < until and sweeping.poll() is None
                time.sleep(0.005)
            started[0].kill()
            _, error = sweeping.communicate(timeout=LONG)
    assert sweeping.returncode == 2
    assert (
        error.count("\n") == 1
        and "the connection to the scheduler is lost. The completed rows are kept" in error
    )
    sweep(out="out", resume=True, **MANY)
    assert lines("out") == lines("here")


def test_no_scheduler_is_one_line(monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr("quadcore.studies.sweep.dask._PATIENCE", 0.5)
    levels = logging.getLogger("distributed").level
    with pytest.raises(qc.QuadcoreError, match=r"tcp://127.0.0.1:1: no scheduler answers"):
        sweep(dask="tcp://127.0.0.1:1")
    assert logging.getLogger("distributed").level == levels


# MPI

MPI = """
from mpi4py.futures import MPIPoolExecutor
from sweeps import sweep
if __name__ == "__main__":
    with MPIPoolExecutor() as executor:
        sweep(out="there", executor=executor)
"""


def test_mpi_gives_the_same_table():
    pytest.importorskip("mpi4py", reason="mpi4py is not installed")
    mpiexec = shutil.which("mpiexec")
    if mpiexec is None:
        pytest.skip("mpiexec is not installed")
    sweep(out="here")
    Path("flown.py").write_text(MPI)
    # As root and on few cores, as in a container.
    words = [mpiexec, "--allow-run-as-root", "--oversubscribe", "-n", "3"]
    paths = [str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")]
    done = subprocess.run(
        [*words, sys.executable, "-m", "mpi4py.futures", "flown.py"],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))},
        timeout=LONG,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert lines("here") == lines("there")
