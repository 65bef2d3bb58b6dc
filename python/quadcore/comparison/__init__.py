"""The same flight under many models and parameters, and how the flights differ."""

from .compare import Comparison, compare
from .difference import Difference

__all__ = ["Comparison", "Difference", "compare"]
