"""Gains by search: tuned on some references and vehicles, judged on others."""

from .search import Tuning, tune

__all__ = ["Tuning", "tune"]
