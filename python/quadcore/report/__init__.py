"""Plots and pages: colours, axes, the player, templates."""
