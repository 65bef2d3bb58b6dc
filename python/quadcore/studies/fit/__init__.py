"""Parameters from a flight log.

A `record` is what was commanded and what was measured; `horizons` fly short pieces of it on a
batch; a `problem` says what is free and what that leaves over; `search` makes it small; `identify`
tells what the flight says of each parameter, and `document` writes them into the URDF. `fit` puts
that together.
"""

from .fit import Fit as Fit
from .fit import fit as fit
