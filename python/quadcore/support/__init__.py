"""Helpers of all layers: arguments, files, interrupts, warnings and rotations."""
