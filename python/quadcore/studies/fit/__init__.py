"""Fit of model parameters to a flight log.

A `record` contains commands and measurements. `horizons` simulates short pieces of it on a batch,
`problem` computes the residuals, and `search` minimises them over the free parameters.
`identifiability` analyses the result, and `model_text` writes it into the URDF.
"""

from .fit import Fit as Fit
from .fit import fit as fit
