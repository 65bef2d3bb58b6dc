"""What the tests share."""

from __future__ import annotations

import os
import signal

import pytest
from hypothesis import settings

# Before numpy is imported: the tests, which run side by side, solve problems too small for threads.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

settings.register_profile("quadcore", deadline=None)  # a busy machine is no fault
settings.load_profile("quadcore")

# Ignored, as under nohup, it would be so in every process that a test starts.
signal.signal(signal.SIGHUP, signal.SIG_DFL)

pytest.register_assert_rewrite("faults", "hooked", "relays")


@pytest.fixture
def in_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def toy(tmp_path, monkeypatch):
    """Folder, made the working directory, that holds a good toy.urdf and a good toy.world."""
    import faults

    monkeypatch.chdir(tmp_path)
    (tmp_path / "toy.urdf").write_text(faults.MODEL)
    (tmp_path / "toy.world").write_text(faults.WORLD)
    return tmp_path


@pytest.fixture
def flown(toy):
    """Maker of simulations of the toy with more in its model's end, or its world's."""

    import faults

    import quadcore as qc

    def make(more="", world="", **options):
        (toy / "toy.urdf").write_text(faults.MODEL.replace("</robot>", f"{more}</robot>"))
        (toy / "toy.world").write_text(faults.WORLD.replace("  </world>", f"{world}</world>"))
        return qc.Simulation("toy.urdf", world="toy.world", **options)

    return make


@pytest.fixture
def hangar(tmp_path):
    """Maker of simulations of small vehicles; see vehicles.Hangar."""
    from vehicles import Hangar

    return Hangar(tmp_path)


@pytest.fixture
def fitted(tmp_path):
    """Maker of fireflies that carry more; see fitted.firefly_with."""
    from fitted import firefly_with

    return lambda *parts, **options: firefly_with(tmp_path, *parts, **options)


@pytest.fixture(scope="session")
def thesis():
    """The thesis' quadrotor as its mathematical model needs it."""
    import quadcore as qc
    from quadcore.thesis.chapter2 import Vehicle

    return Vehicle.of(qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1}))


@pytest.fixture(scope="session")
def study():
    """The flights of the validation, slowed down by 1 and 8, without drag and with all."""
    from flights import ENGINES

    from quadcore.thesis.validation import Experiment, run_study

    return run_study(Experiment.of(), ENGINES, [1, 8], ["none", "all"])


@pytest.fixture(scope="session")
def folders_of_hook_plugins(tmp_path_factory):
    from builds import ROOT, build_once

    sources = (ROOT / "examples" / "hooks", ROOT / "tests" / "python" / "plugins")
    return [build_once(source, tmp_path_factory) for source in sources]


@pytest.fixture
def hook_plugins(folders_of_hook_plugins, monkeypatch):
    """The examples with one hook each, and the plugin that publishes what its hooks receive."""
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", ":".join(map(str, folders_of_hook_plugins)))


@pytest.fixture(scope="session")
def folder_of_relay(tmp_path_factory):
    from builds import ROOT, build_once

    return build_once(ROOT / "tests" / "plugins" / "relay", tmp_path_factory)


@pytest.fixture
def relays(toy, folder_of_relay, monkeypatch):
    """Maker of the toy with relays and other plugins; see relays.toy_with."""
    from relays import toy_with

    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", str(folder_of_relay))
    return toy_with


@pytest.fixture
def alarm():
    """A function that interrupts this process after some seconds of processor time."""
    before = signal.signal(signal.SIGPROF, signal.default_int_handler)
    yield lambda seconds: signal.setitimer(signal.ITIMER_PROF, seconds)
    signal.setitimer(signal.ITIMER_PROF, 0)
    signal.signal(signal.SIGPROF, before)
