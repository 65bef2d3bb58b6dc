"""Views of logs and simulations in a browser or a notebook."""

from __future__ import annotations

import html
import sys
from pathlib import Path
from typing import Any, Dict, Mapping, Optional, Sequence, Union

import numpy as np

from .._core import InputError, Model
from ..model.description import read_model
from ..model.obstacles import draw_world
from ..model.visuals import read_vehicle
from ..report.cameras import CAMERAS
from ..report.drawn_vehicle import DrawnVehicle, DrawnWorld
from ..report.gif import make_gif
from ..report.page import embed_image
from ..report.page_server import PageServer, open_browser
from ..report.player import PlayerFlight, make_page
from ..support.arguments import shorten
from ..support.output_files import atomic_write, check_writable, encode_text
from .flight import list_columns
from .live_view import LiveView
from .log import Log
from .rows import Rows
from .simulation import Simulation

_HEIGHT = 760  # px; height of the page in a notebook

Shown = Union[Simulation, Log, Sequence[Log], Mapping[str, Log]]
Vehicle = Union[str, Path, Model]


class View:
    """View of a simulation or of logs, as returned by `view`.

    Parameters
    ----------
    shown, model, camera
        As for `view`.

    Attributes
    ----------
    url : str
        Address of the page on this machine.
    """

    def __init__(self, shown: Shown, model: Optional[Vehicle], camera: str) -> None:
        self._camera = camera
        self._live: Optional[LiveView] = None
        if isinstance(shown, Simulation):
            columns = list_columns(shown)
            self._simulation: Optional[Simulation] = shown
            self._vehicle: Optional[DrawnVehicle] = read_vehicle(shown.model)
            self._world = draw_world(shown.world)
            self._rows = Rows(shown, columns)
            self._live = LiveView(shown, columns, every=1, camera=camera)
            self._server = self._live.page
            self.sync()
        else:
            self._simulation = None
            self._vehicle = None if model is None else read_vehicle(_read(model))
            self._world = DrawnWorld()
            self._logs = _name_logs(shown)
            self._server = PageServer(self._make_page())
        self.url = self._server.url

    def sync(self) -> None:
        """Show the current state of the simulation; a view of logs does not change.

        Raises
        ------
        InputError
            If the time of the simulation has decreased.
        """
        simulation = self._simulation
        if simulation is None or self._live is None:
            return
        state = simulation.state
        before = self._rows.log().time[-1:]
        if len(before) and state.time < before[0]:
            raise InputError(
                f"the time went back from {before[0]:g} s to {state.time:g} s. Make a new view."
            )
        if len(before) and state.time == before[0]:
            return
        row = [state.time, *state.position, *state.orientation, *state.linear_velocity]
        table = np.array([[*row, *state.angular_velocity, *state.rotor_velocity]])
        self._rows.receive(table, np.empty((0, 0, 6)))
        self._live.receive(table, np.empty((0, 0, 6)))

    def save(self, path: Union[str, Path]) -> None:
        """Write everything that the view has shown as a page (.html) or an animation (.gif).

        Parameters
        ----------
        path : str or path
            Path of the file. A GIF requires Chromium or Chrome.

        Raises
        ------
        InputError
            If the suffix is not supported, or the file cannot be written.
        """
        file = Path(path)
        if file.suffix.lower() not in (".html", ".gif"):
            raise InputError(f"{file}: is no page or GIF. Name a file that ends in .html or .gif.")
        check_writable(file)
        page = self._make_page()
        content = encode_text(page) if file.suffix.lower() == ".html" else make_gif(page)
        with atomic_write(file) as stream:
            stream.write(content)

    def close(self) -> None:
        """Stop serving the page."""
        self._server.close()

    def _make_page(self) -> str:
        if self._simulation is not None:
            self._logs = {self._simulation.model.name: self._rows.log()}
        flights = [PlayerFlight(name, log, self._vehicle) for name, log in self._logs.items()]
        return make_page(flights, ", ".join(self._logs), self._world, self._camera)

    def _repr_html_(self) -> str:
        """Return a frame with the page, and a static image for viewers without scripts."""
        if self._simulation is not None:
            source = f'src="{self.url}"'
        else:
            source = f'srcdoc="{html.escape(self._make_page())}"'
        frame = f'<iframe {source} style="width: 100%; height: {_HEIGHT}px; border: 0"></iframe>'
        return f"{frame}{_make_picture(next(iter(self._current_logs().values())))}"

    def _current_logs(self) -> Dict[str, Log]:
        return self._logs if self._simulation is None else {"": self._rows.log()}

    def __repr__(self) -> str:
        return f"<View at {self.url}>"


def view(
    shown: Shown,
    model: Optional[Vehicle] = None,
    camera: str = CAMERAS[0],
    browser: Optional[bool] = None,
) -> View:
    """Show logs or a simulation in the browser, or in a notebook.

    Parameters
    ----------
    shown : Simulation, Log, sequence of Log, or mapping of str to Log
        Simulation to show while it steps, with `View.sync`; or logs with their names.
    model : str, path or Model, optional
        Model of the logs (default: a star of arms). A simulation shows its own model.
    camera : str, default "follow"
        Initial camera: "follow", "chase", "top", "side" or "whole".
    browser : bool, optional
        Whether to open the browser. By default, it opens on a machine with a screen, but not in a
        notebook.

    Returns
    -------
    View
        View. As the last value of a notebook cell, it shows the animation.

    Raises
    ------
    InputError
        If there is nothing to show, or the model does not match the logs.
    """
    if isinstance(shown, Simulation) and model is not None:
        raise InputError("model: a simulation shows its own vehicle. Leave model out.")
    made = View(shown, model, camera)
    if browser or (browser is None and "ipykernel" not in sys.modules):
        open_browser(made.url)
    return made


def _name_logs(shown: Any) -> Dict[str, Log]:
    if isinstance(shown, Log):
        return {shown.title or "flight": shown}
    if isinstance(shown, Mapping):
        named = {str(name): log for name, log in shown.items()}
    elif isinstance(shown, Sequence) and not isinstance(shown, str):
        named = {f"flight {i}": log for i, log in enumerate(shown, start=1)}
    else:
        raise InputError(f"shown: give a simulation, a log or logs, not {shorten(shown)}")
    wrong = next((log for log in named.values() if not isinstance(log, Log)), None)
    if wrong is not None:
        raise InputError(f"shown: give a simulation, a log or logs, not {shorten(wrong)}")
    return named


def _read(model: Vehicle) -> Model:
    return model if isinstance(model, Model) else read_model(model)


def _make_picture(log: Log) -> str:
    """Make a static image that is hidden where frames and styles work."""
    from ..report.log_plots import draw_overview  # matplotlib is slow to import
    from ..report.plots import png

    picture = embed_image(png(draw_overview(log)), "position and attitude")
    return (
        "<style>.quadcore-picture { display: none; }</style>"
        f'<div class="quadcore-picture">{picture}</div>'
    )
