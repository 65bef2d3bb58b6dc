"""Export of a vehicle in its world as an FMU (functional mock-up unit) for co-simulation."""

from __future__ import annotations

from .export import export_fmu

__all__ = ["export_fmu"]
