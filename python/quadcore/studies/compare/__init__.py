"""The same flight under many models and parameters, and how the flights differ."""

from .compare import compare
from .model_differences import Difference
from .result import Comparison

__all__ = ["Comparison", "Difference", "compare"]
