"""Comparison of one flight with different models and parameters."""

from .compare import compare
from .model_differences import Difference
from .result import Comparison

__all__ = ["Comparison", "Difference", "compare"]
