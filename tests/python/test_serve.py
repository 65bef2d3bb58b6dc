"""Flights that a client drives over a socket."""

import os
import re
import signal
import socket
import struct
import subprocess
import sys
import threading

import numpy as np
import pytest

import quadcore as qc
from quadcore.serve import Client, Server, ServerError

SPEEDS = ([480.0, -470.0, 490.0, -475.0], [470.0, -480.0, 480.0, -490.0])
NOISY = {"odometry.positionNoise": "0.01"}
FAST = {"max_velocity": "1e6"}


@pytest.fixture
def served():
    """An address, and what the server says of its clients."""
    simulation = qc.Simulation("quadrotor", engine="eigen", parameters=NOISY, xacro_args=FAST)
    said = []
    with Server(simulation, topics=["odom"]) as server:
        thread = threading.Thread(target=server.serve, args=(said.append,), daemon=True)
        thread.start()
        yield int(server.address.rpartition(":")[2]), said
    thread.join(60)
    assert not thread.is_alive()  # closed, it serves nobody any more


def ends(said):
    """Whether the server has said something."""
    for _ in range(2000):
        if said:
            return True
        threading.Event().wait(0.01)
    return False


def in_process(seed=0, steps=(3, 7)):
    sim = qc.Simulation("quadrotor", engine="eigen", parameters=NOISY, seed=seed)
    rows = []
    for speeds, count in zip(SPEEDS, steps):
        sim.command(speeds)
        log = sim.run(count * sim.dt, topics=["odom"])
        odometry = [column[-1] for column in log.topics["odom"].values()]
        rows.append([*log.table[-1], *odometry])
    return rows


def test_a_served_flight_is_the_one_in_the_process_to_the_last_bit(served):
    port, _ = served
    with Client(port) as client:
        rows = [client.step(speeds, steps) for speeds, steps in zip(SPEEDS, (3, 7))]
        assert (client.dt, client.rotors) == (0.001, 4)
        names = client.columns
    np.testing.assert_array_equal(rows, in_process())
    assert names[:4] == ["t", "x", "y", "z"] and "odom.x" in names


def test_each_client_and_each_reset_begins_anew(served):
    port, _ = served
    with Client(port) as client:
        first = client.step(SPEEDS[0], 50)
        client.reset()
        assert client.step(SPEEDS[0], 50) == first
        client.reset(seed=3)
        other = client.step(SPEEDS[0], 50)
        client.reset()
        assert client.step(SPEEDS[0], 50) == other  # the seed stays
    with Client(port) as client:
        assert client.step(SPEEDS[0], 50) == first  # but not for others


def test_no_command_keeps_the_one_before_and_no_step_shows_the_row(served):
    port, _ = served
    with Client(port) as client:
        client.step(SPEEDS[0], 5)
        apart = client.step(None, 5)
        assert client.step(steps=0) == apart
        client.reset()
        assert client.step(SPEEDS[0], 10) == apart


@pytest.mark.parametrize(
    ("ask", "what"),
    [
        (lambda client: client.step([1.0, 2.0]), "the command has 2 rotor speeds"),
        (lambda client: client.step([float("nan")] * 4), "not a finite number"),
        (lambda client: client.step(SPEEDS[0], 1.5), "the number of steps is 1.5"),
        (lambda client: client.step(SPEEDS[0], -1), "the number of steps is -1"),
        (lambda client: client.step(SPEEDS[0], float("nan")), "the number of steps is nan"),
        (lambda client: client.reset(0.5), "the seed is 0.5"),
    ],
)
def test_a_wrong_request_is_refused_and_changes_nothing(served, ask, what):
    port, _ = served
    with Client(port) as client:
        before = client.step(SPEEDS[0], 5)
        with pytest.raises(ServerError, match=re.escape(what)) as refused:
            ask(client)
        assert not refused.value.failed
        assert client.step(steps=0) == before


def message(*numbers):
    return struct.pack(f"<{len(numbers)}d", *numbers)


@pytest.mark.parametrize(
    ("sent", "what"),
    [
        (message(0, 1, 2), "unsupported protocol version 2 (expected 1)"),
        (message(9, 0), "message with kind 9"),
        (message(float("nan"), 0), "message with kind nan"),
        (message(2, 1e9), "message with length 1e+09"),
        (message(2, -1), "message with length -1"),
        (message(2, 0), "the number of steps is missing"),
    ],
)
def test_what_is_no_request_is_answered_with_why(served, sent, what):
    port, _ = served
    with socket.create_connection(("127.0.0.1", port)) as other:
        other.sendall(sent)
        other.shutdown(socket.SHUT_WR)
        answer = b"".join(iter(lambda: other.recv(4096), b""))
    numbers = struct.unpack(f"<{len(answer) // 8}d", answer)
    assert numbers[0] == 1 and numbers[1] == len(numbers) - 2
    assert what in bytes(map(int, numbers[2:])).decode()
    with Client(port) as client:  # the next is served
        client.step(SPEEDS[0])


@pytest.mark.parametrize(
    ("sent", "what"),
    [
        (b"half", "incomplete message: 4 bytes"),
        (message(2, 5, 1, 400), "incomplete message: 16 of 40 bytes"),
    ],
)
def test_a_client_that_dies_within_a_message_is_reported(served, sent, what):
    port, said = served
    with socket.create_connection(("127.0.0.1", port)) as other:
        other.sendall(sent)
    assert ends(said)
    assert said[0].startswith("client 1: ") and what in said[0]
    with Client(port) as client:
        client.step(SPEEDS[0])


def test_steps_of_a_client_that_has_gone_are_not_flown(served):
    """Of the billion that it asked for; the next client is served."""
    port, said = served
    with socket.create_connection(("127.0.0.1", port)) as gone:
        gone.sendall(struct.pack("<3d", 2, 1, 1e9))
    assert ends(said)
    assert re.fullmatch(
        r"client 1: (disconnected before its steps were complete|.*reset by peer)", said[0]
    )
    with Client(port) as client:
        np.testing.assert_array_equal(client.step(SPEEDS[0], 3), in_process()[0])


def test_steps_of_a_client_that_sent_more_and_went_are_not_flown(served):
    port, said = served
    with socket.create_connection(("127.0.0.1", port)) as gone:
        gone.sendall(struct.pack("<3d", 2, 1, 1e9) + b"x")
    assert ends(said)
    with Client(port) as client:
        np.testing.assert_array_equal(client.step(SPEEDS[0], 3), in_process()[0])


@pytest.fixture
def impatient():
    """As `served`, with a short time-out."""
    said = []
    with Server(qc.Simulation("quadrotor", engine="eigen"), timeout=0.2) as server:
        thread = threading.Thread(target=server.serve, args=(said.append,), daemon=True)
        thread.start()
        yield int(server.address.rpartition(":")[2]), said
    thread.join(60)
    assert not thread.is_alive()


@pytest.mark.parametrize(
    ("sent", "why"),
    [
        (b"", "no message for 0.2 s"),
        (b"half", "silent within a message for 0.2 s"),
        (message(2, 5, 1), "silent within a message for 0.2 s"),
    ],
)
def test_a_silent_client_is_dropped_and_the_next_one_served(impatient, sent, why):
    port, said = impatient
    with socket.create_connection(("127.0.0.1", port)) as silent:
        silent.sendall(sent)
        with Client(port) as client:
            client.step(SPEEDS[0])
        assert silent.recv(1) == b""
    assert said == [f"client 1: {why}"]


def test_a_client_that_reads_no_answer_is_dropped(impatient):
    port, said = impatient
    with socket.create_connection(("127.0.0.1", port)) as deaf:
        deaf.settimeout(60)
        with pytest.raises(ConnectionError):
            while True:
                deaf.sendall(message(1, 0) * 1000)
    assert ends(said) and said == ["client 1: no answer read for 0.2 s"]


def test_a_client_may_think_for_as_long_as_nobody_else_waits(impatient):
    port, said = impatient
    with Client(port) as thinking:
        first = thinking.step(SPEEDS[0])
        threading.Event().wait(0.5)  # longer than the time-out
        assert thinking.step(steps=0) == first
        with Client(port) as client:
            client.step(SPEEDS[0])
        with pytest.raises((ConnectionError, ServerError)):
            thinking.step(steps=0)
    assert said == ["client 1: no message for 0.2 s"]


def test_a_thinking_client_outlives_the_end_of_the_server():
    server = Server(qc.Simulation("quadrotor", engine="eigen"), timeout=0.05)
    thread = threading.Thread(target=server.serve, args=(print,), daemon=True)
    thread.start()
    with Client(int(server.address.rpartition(":")[2])) as client:
        server.close()
        threading.Event().wait(0.2)  # longer than the time-out
        client.step(SPEEDS[0])
    thread.join(60)
    assert not thread.is_alive()


def test_a_time_out_is_positive():
    for timeout in (0, -1, float("nan"), float("inf")):
        with pytest.raises(qc.InputError, match="the timeout is"):
            Server(qc.Simulation("quadrotor", engine="eigen"), timeout=timeout)


class Disk:
    """Takes so many rows, and is full then."""

    def __init__(self, room):
        self.room, self.wrenches = room, False

    def receive(self, table, wrenches):
        self.room -= len(table)
        if self.room < 0:
            raise qc.InputError("log.csv: cannot be written: No space left on device")

    def close(self):
        pass


def test_a_flight_whose_log_is_not_written_further_has_failed():
    said = []
    disks = [Disk(10), Disk(1000)]
    with Server(qc.Simulation("quadrotor", engine="eigen"), record=lambda: disks.pop(0)) as server:
        thread = threading.Thread(target=server.serve, args=(said.append, 1))
        thread.start()
        with Client(int(server.address.rpartition(":")[2])) as client:
            before = client.step(SPEEDS[0], 5)
            for _ in range(2):
                with pytest.raises(ServerError, match="No space left") as refused:
                    client.step(SPEEDS[0], 20)
                assert refused.value.failed
            client.reset()
            assert client.step(SPEEDS[0], 5) == before
        thread.join(60)
    assert said == ["client 1: log.csv: cannot be written: No space left on device"]


def test_a_full_disk_refuses_the_first_step_and_changes_nothing(tmp_path):
    disks = [Disk(0), Disk(1000)]
    with Server(qc.Simulation("quadrotor", engine="eigen"), record=lambda: disks.pop(0)) as server:
        thread = threading.Thread(target=server.serve, args=(print, 1))
        thread.start()
        with Client(int(server.address.rpartition(":")[2])) as client:
            with pytest.raises(ServerError, match="No space left") as refused:
                client.step(SPEEDS[0], 5)
            assert not refused.value.failed and client.step(steps=0)[0] == 0
            client.step(SPEEDS[0], 5)
        thread.join(60)


def test_a_full_disk_is_reported_to_the_client_of_the_command(tmp_path):
    log = tmp_path / "log.csv"
    log.symlink_to("/dev/full")
    command = [sys.executable, "-m", "quadcore", "serve", "quadrotor", "--engine", "eigen"]
    server = subprocess.Popen([*command, "--log", log], stdout=subprocess.PIPE, text=True)
    port = int(server.stdout.readline().rpartition(":")[2])
    with Client(port) as client:
        with pytest.raises(ServerError, match=r"log\.csv: cannot be written: No space left"):
            client.step(SPEEDS[0])
        assert client.step(steps=0)[0] == 0
    server.send_signal(signal.SIGTERM)
    assert server.wait() == 143


def test_a_flight_that_fails_stands_until_a_reset(served):
    port, _ = served
    with Client(port) as client:
        start = client.step(steps=0)
        for _ in range(2):
            with pytest.raises(ServerError, match="the flight failed at t = ") as failed:
                client.step([1e5] * 4, 1000)
            assert failed.value.failed
        assert client.reset() == start


def test_a_served_flight_may_fly_at_the_end_of_a_unix_socket(tmp_path):
    path = str(tmp_path / "socket")
    simulation = qc.Simulation("quadrotor", engine="eigen")
    with Server(simulation, path) as server:
        thread = threading.Thread(target=server.serve, args=(print, 1))
        thread.start()
        with Client(path) as client:
            client.step(SPEEDS[0])
        thread.join()
    assert not os.path.exists(path)


def test_an_address_that_is_taken_is_refused(served, tmp_path):
    port, _ = served
    taken = tmp_path / "file"
    taken.write_text("not a socket")
    for address in (port, str(taken)):
        with pytest.raises(qc.InputError, match="cannot listen at"):
            Server(qc.Simulation("quadrotor"), address)
    assert taken.read_text() == "not a socket"


def test_an_unwritable_log_is_refused_before_any_flight(tmp_path):
    def unwritable():
        raise qc.InputError("the log cannot be written")

    with Server(qc.Simulation("quadrotor"), record=unwritable) as server:
        thread = threading.Thread(target=server.serve, args=(print, 1))
        thread.start()
        with Client(int(server.address.rpartition(":")[2])) as client:
            with pytest.raises(ServerError, match="cannot be written") as refused:
                client.step(SPEEDS[0])
            assert not refused.value.failed and client.step(steps=0)[0] == 0
        thread.join()


def test_a_socket_of_another_kind_is_left_alone(tmp_path):
    path = str(tmp_path / "socket")
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as other:
        other.bind(path)
        with pytest.raises(qc.InputError, match="cannot listen at"):
            Server(qc.Simulation("quadrotor"), path)
        assert os.path.exists(path)


def test_a_socket_that_a_killed_server_left_is_taken_over(tmp_path):
    path = str(tmp_path / "socket")
    left = socket.socket(socket.AF_UNIX)
    left.bind(path)
    left.close()
    with Server(qc.Simulation("quadrotor"), path):
        pass


@pytest.mark.parametrize("suffix", ["csv", "mat"])
def test_the_command_serves_logs_and_ends_at_a_signal(suffix, tmp_path):
    command = [sys.executable, "-m", "quadcore", "serve", "quadrotor", "--engine", "eigen"]
    options = ["--log", str(tmp_path / f"flown.{suffix}"), "--log-every", "5"]
    server = subprocess.Popen([*command, *options], stdout=subprocess.PIPE, text=True)
    port = int(server.stdout.readline().rpartition(":")[2])
    rows = []
    for speeds in SPEEDS:
        with Client(port) as client:
            rows.append(client.step(speeds, 20))
            client.reset()  # nothing is flown, and nothing written
    with Client(port):
        pass
    server.send_signal(signal.SIGTERM)
    assert server.wait() == 143
    names = [f"flown.{suffix}", f"flown-2.{suffix}"]
    assert sorted(os.listdir(tmp_path)) == sorted(names)
    for name, row in zip(names, rows):
        log = qc.Log.of_file(tmp_path / name)
        np.testing.assert_allclose(log.time, np.arange(5) * 0.005, atol=1e-15)
        assert tuple(log.table[-1]) == row


def test_logs_that_are_there_are_not_written_over_by_later_flights(tmp_path):
    (tmp_path / "flown-2.csv").write_text("of somebody else")
    command = [sys.executable, "-m", "quadcore", "serve", "quadrotor", "--engine", "eigen"]
    options = ["--log", str(tmp_path / "flown.csv")]
    server = subprocess.Popen([*command, *options], stdout=subprocess.PIPE, text=True)
    port = int(server.stdout.readline().rpartition(":")[2])
    for _ in range(2):
        with Client(port) as client:
            client.step(SPEEDS[0])
    server.send_signal(signal.SIGTERM)
    assert server.wait() == 143
    assert sorted(os.listdir(tmp_path)) == ["flown-2.csv", "flown-3.csv", "flown.csv"]
    assert (tmp_path / "flown-2.csv").read_text() == "of somebody else"


def test_a_client_needs_the_standard_library_alone():
    code = (
        "import sys, types; package = types.ModuleType('serve'); package.__path__ = [sys.argv[1]]; "
        "sys.modules['serve'] = package; import serve.client; "
        "print([name for name in sys.modules if name.partition('.')[0] in ('numpy', 'quadcore')])"
    )
    folder = os.path.dirname(sys.modules["quadcore.serve"].__file__)
    run = subprocess.run(
        [sys.executable, "-c", code, folder], stdout=subprocess.PIPE, text=True, check=True
    )
    assert run.stdout.strip() == "[]"
