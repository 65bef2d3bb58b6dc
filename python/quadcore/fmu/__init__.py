"""FMUs: a vehicle in its world as a file that any importer of FMI 2.0 for co-simulation flies."""

from __future__ import annotations

from .export import export_fmu

__all__ = ["export_fmu"]
