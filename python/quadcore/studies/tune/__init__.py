"""Gains by search: tuned on some references and vehicles, judged on others."""

from .search import Tuning
from .tune import tune

__all__ = ["Tuning", "tune"]
