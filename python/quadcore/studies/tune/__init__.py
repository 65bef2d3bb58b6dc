"""Gain tuning with training cases, checked on held-out cases."""

from .search import Tuning
from .tune import tune

__all__ = ["Tuning", "tune"]
