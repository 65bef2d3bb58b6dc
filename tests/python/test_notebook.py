"""What notebooks show of simulations and of what flights leave behind."""

from __future__ import annotations

from html.parser import HTMLParser

import quadcore as qc


class Cells(HTMLParser):
    """Collects the cells of tables; refuses tags that are not closed."""

    def __init__(self, page):
        super().__init__()
        self.open, self.rows = [], []
        self.feed(page)
        assert self.open == []

    def handle_starttag(self, tag, _):
        if tag == "tr":
            self.rows.append([])
        if tag != "img":
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] in ("td", "th"):
            self.rows[-1].append(data)


def test_a_simulation_is_a_table_of_what_flies():
    rows = dict(Cells(qc.Simulation("quadrotor", spawn=(1, 2, 3))._repr_html_()).rows)
    assert rows["vehicle"] == "1.04 kg, 4 rotors"
    assert rows["position"] == "1, 2, 3 m"


def test_a_comparison_is_a_table_of_differences():
    gains = [5e-4, -1, 1e-3]
    found = qc.compare(
        "quadrotor", {"motorpid_plugin.kp": gains, "engine": ["eigen"]}, duration=0.05
    )
    head, first, failed, last = Cells(found._repr_html_()).rows
    assert head[:2] == ["motorpid_plugin.kp", "max position (m)"]
    assert first[:2] == ["0.0005", "0"]
    assert "out of range" in failed[1]
    assert last[0] == "0.001"
    assert repr(found) == "<Comparison, 3 flights: 2 flown, 1 failed>"


def test_an_evaluation_is_a_table_of_what_was_reached():
    found = qc.evaluate(["pid", "geometric"], "hover", duration=0.1)
    head, *rows = Cells(found._repr_html_()).rows
    assert head[:3] == ["controller", "flown", "RMS (m)"]
    assert [row[:2] for row in rows] == [["pid", "1 of 1"], ["geometric", "1 of 1"]]
    assert repr(found) == "<Evaluation, 2 flights: 2 flown, 0 failed>"
