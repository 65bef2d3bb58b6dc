"""How SIGINT, SIGTERM and SIGHUP are heard, and held while something must be done wholly."""

from __future__ import annotations

import signal
import time
from importlib.machinery import ExtensionFileLoader

import pytest

from quadcore.cli import main
from quadcore.support import interrupts
from quadcore.support.output_files import atomic_write

SIGNALS = list(interrupts.SIGNALS)


@pytest.mark.parametrize("number", SIGNALS)
def test_a_signal_that_is_sent_twice_is_heard_once(number):
    kept = []
    with pytest.raises(interrupts.Interrupted) as stop, interrupts.raise_on_signals():
        try:
            signal.raise_signal(number)
        finally:
            signal.raise_signal(number)  # `timeout` signals the process and its group
            kept.append("kept")
    assert kept == ["kept"]
    assert interrupts.exit_status(stop.value) == 128 + number


def test_an_interrupt_that_others_take_for_a_fault_is_an_interrupt(capsys, monkeypatch, tmp_path):
    import xacro

    model = tmp_path / "new.urdf.xacro"  # of which no expansion is kept
    model.write_text('<robot name="new" xmlns:xacro="http://www.ros.org/wiki/xacro"/>')

    def expand(*_, **__):
        try:
            signal.raise_signal(signal.SIGTERM)
        except BaseException:
            raise NameError("name 'x' is not defined") from None

    monkeypatch.setattr(xacro, "process_file", expand)
    assert main(["info", str(model)]) == 143
    assert capsys.readouterr().err == "interrupted\n"


@pytest.mark.parametrize("number", SIGNALS)
def test_an_interrupt_that_met_the_start_of_a_module_is_an_interrupt(number):
    with pytest.raises(interrupts.Interrupted) as stop, interrupts.raise_on_signals():
        try:
            signal.raise_signal(number)
        except BaseException:
            raise ImportError("initialization failed") from None  # as matplotlib's ft2font says it
    assert stop.value.number == number


@pytest.mark.parametrize("number", SIGNALS)
def test_an_interrupt_waits_for_the_start_of_a_module_in_c(number):
    """Such as matplotlib's ft2font: cut off, it hangs, or aborts when the interpreter ends."""
    done = []

    class Starting(ExtensionFileLoader):
        def exec_module(self, module):
            signal.raise_signal(number)
            done.append("started")

    with pytest.raises(interrupts.Interrupted) as stop, interrupts.raise_on_signals():
        Starting("module", "module.so").exec_module(None)
        give_up = time.monotonic() + 60
        while time.monotonic() < give_up:
            time.sleep(0.01)
    assert done == ["started"] and stop.value.number == number


def test_handlers_are_as_before_afterwards():
    before = [signal.getsignal(number) for number in SIGNALS]
    with interrupts.raise_on_signals(), interrupts.hold_signals():
        pass
    assert [signal.getsignal(number) for number in SIGNALS] == before


@pytest.mark.parametrize("number", SIGNALS)
def test_what_is_held_is_done_before_the_interrupt(number):
    done = []
    with pytest.raises(KeyboardInterrupt), interrupts.raise_on_signals(), interrupts.hold_signals():
        with interrupts.hold_signals():
            signal.raise_signal(number)
            done.append("inner")
        done.append("outer")
    assert done == ["inner", "outer"]


@pytest.mark.parametrize("number", SIGNALS)
def test_a_held_signal_is_raised_if_the_block_raises_an_error(number):
    with pytest.raises(interrupts.Interrupted) as stop, interrupts.raise_on_signals():
        try:
            with interrupts.hold_signals(), interrupts.hold_signals():
                signal.raise_signal(number)
                raise OSError("the disk is full")
        except OSError:
            pass  # as code that continues after an error of the block
    assert stop.value.number == number
    assert isinstance(stop.value.__context__, OSError)


def test_a_second_interrupt_ends_a_held_block_at_once():
    heard = []
    before = signal.signal(signal.SIGINT, lambda number, _: heard.append(number))
    try:
        with pytest.raises(KeyboardInterrupt), interrupts.hold_signals():
            signal.raise_signal(signal.SIGINT)
            assert heard == []
            signal.raise_signal(signal.SIGINT)
            assert heard == [signal.SIGINT]
            raise KeyboardInterrupt
        assert heard == [signal.SIGINT]
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("number", SIGNALS)
def test_an_interrupted_file_leaves_the_old_one_and_nothing_else(number, tmp_path):
    (tmp_path / "a").write_text("old")
    with pytest.raises(KeyboardInterrupt), interrupts.raise_on_signals(), atomic_write(
        tmp_path / "a"
    ) as file:
        file.write(b"new")
        signal.raise_signal(number)
    assert (tmp_path / "a").read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["a"]
