"""The toy with plugins that hand topics on."""

from __future__ import annotations

from pathlib import Path

from faults import MODEL

import quadcore as qc

FIRST = 2 + MODEL[: MODEL.index("<gazebo>")].count("\n")
"""Line of the first element."""


def element(name, **tags):
    inner = "".join(f"<{tag}>{value}</{tag}>" for tag, value in tags.items())
    return f'<plugin name="{name}" filename="librelay_plugin.so">{inner}</plugin>'


def odometry(name, **tags):
    return element(name, **tags).replace("librelay", "libodometry")


def toy_with(*elements, **options):
    """The toy, written into the working directory, with these elements a line each."""
    assert "\n" not in "".join(elements)
    text = MODEL.replace("<gazebo>\n", "<gazebo>\n" + "".join(f"{e}\n" for e in elements))
    Path("toy.urdf").write_text(text)
    return qc.Simulation("toy.urdf", **options)
