"""Cameras of the player."""

CAMERAS = ("follow", "chase", "top", "side", "whole")
"""Names of the cameras; the first is the default."""
