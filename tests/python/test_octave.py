"""What lies in matlab/, run by Octave and held against Python."""

import shutil
import subprocess
import threading
from pathlib import Path

import numpy as np
import pytest
import scipy.io

import quadcore as qc
from quadcore.cli import main
from quadcore.serve import Server
from quadcore.studies.tracking_metrics import measure
from quadcore.thesis.chapter2.model import MathematicalModel
from quadcore.thesis.chapter2.vehicle import Vehicle

MATLAB = Path(__file__).resolve().parents[2] / "matlab"
SPAWN = (2, 0, 10)

pytestmark = pytest.mark.skipif(
    shutil.which("octave-cli") is None, reason="needs Octave: apt install octave"
)


def octave(code, folder):
    """Run code; returns the variables that stand at its end."""
    code = f"addpath('{MATLAB}'); {code}; save('-v7', 'left.mat');"
    command = ["octave-cli", "--norc", "--quiet", "--eval", code]
    ran = subprocess.run(command, cwd=folder, stderr=subprocess.PIPE, text=True)
    assert ran.returncode == 0, ran.stderr
    return scipy.io.loadmat(folder / "left.mat", squeeze_me=True)


@pytest.fixture(scope="module", params=["spiral", "step:time=1"])
def log(request):
    sim = qc.Simulation("quadrotor", engine="eigen", spawn=SPAWN)
    return sim.run(12, controller="geometric", reference=request.param, log_every=10)


@pytest.mark.parametrize("suffix", ["mat", "csv"])
def test_octave_measures_a_log_as_python_does(log, suffix, tmp_path):
    log.to_file(tmp_path / f"flight.{suffix}")
    left = octave(f"m = quadcore.measures(quadcore.read_log('flight.{suffix}'))", tmp_path)
    wanted = measure(log, 0.0, qc.Simulation("quadrotor", engine="eigen").rotors)
    for name in left["m"].dtype.names:
        np.testing.assert_allclose(float(left["m"][name]), wanted[name], rtol=1e-12, err_msg=name)
    assert len(left["m"].dtype.names) == 10


def test_the_model_of_chapter_2_in_octave_is_that_in_python(tmp_path):
    file = tmp_path / "vehicle.mat"
    tags = {f"drone_plugin.{name}": value for name, value in FLAPPING.items()}
    sets = [word for key, value in tags.items() for word in ("--set", f"{key}={value}")]
    assert main(["info", "hexarotor", "--vehicle", str(file), *sets]) == 0
    model = MathematicalModel(Vehicle.of(qc.Simulation("hexarotor", parameters=tags)))
    random = np.random.default_rng(1)
    states = random.uniform(-1, 1, (20, 12 + 6))
    states[:, 12:] *= 500
    commands = 500 * random.uniform(-1, 1, (20, 6))
    scipy.io.savemat(tmp_path / "states.mat", {"states": states, "commands": commands})
    left = octave(
        "v = load('vehicle.mat'); load('states.mat'); slopes = zeros(size(states));"
        "for i = 1:rows(states)"
        " slopes(i, :) = quadcore.derivative(v, states(i, :)', commands(i, :)')'; end",
        tmp_path,
    )
    wanted = [model._derivative(*pair) for pair in zip(states, commands)]
    np.testing.assert_allclose(left["slopes"], wanted, rtol=1e-12, atol=1e-12)


FLAPPING = {"flappingA1c": 0.01, "flappingA1s": 0.02, "flappingB1": 0.003, "flappingB2": 0.004}


@pytest.fixture
def port():
    """Of a served flight for one client."""
    with Server(qc.Simulation("quadrotor", spawn=SPAWN)) as server:
        thread = threading.Thread(target=server.serve, args=(print, 1), daemon=True)
        thread.start()
        yield int(server.address.rpartition(":")[2])


def test_the_spiral_flown_from_octave_is_that_of_the_controller_in_the_core(port, tmp_path):
    assert main(["info", "quadrotor", "--vehicle", str(tmp_path / "vehicle.mat")]) == 0
    script = MATLAB / "examples" / "fly_spiral.m"
    left = octave(f"port = {port}; seconds = 3; source('{script}')", tmp_path)
    sim = qc.Simulation("quadrotor", spawn=SPAWN)
    flown = sim.run(3, controller="pid", reference="spiral")
    np.testing.assert_allclose(left["log"], flown.table, rtol=0, atol=1e-9)


def test_octave_reports_what_the_server_refuses(port, tmp_path):
    left = octave(
        f"c = quadcore.connect({port}); quadcore.step(c, [1 2 3 4], 5); try,"
        " quadcore.step(c, [1 NaN 3 4]); catch e, why = e.message; end;"
        " row = quadcore.step(c, [], 0); first = quadcore.restart(c, 3); clear c",
        tmp_path,
    )
    assert "not a finite number" in str(left["why"])
    assert left["row"][0] == 0.005 and left["first"][0] == 0


def test_octave_draws_the_figures_of_a_flight(log, tmp_path):
    log.to_mat(tmp_path / "flight.mat")
    octave("quadcore.figures(quadcore.read_log('flight.mat'), 'figures')", tmp_path)
    names = {file.name for file in (tmp_path / "figures").iterdir() if file.stat().st_size > 5000}
    assert names == {"path.png", "position.png", "attitude.png", "rotors.png", "error.png"}


def test_a_vehicle_is_written_to_mat_files_only(tmp_path, capsys):
    assert main(["info", "quadrotor", "--vehicle", str(tmp_path / "vehicle.txt")]) == 2
    assert "Name a file that ends in .mat" in capsys.readouterr().err
