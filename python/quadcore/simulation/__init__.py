"""Simulations of one vehicle or a batch: commands, flights, logs, scenarios."""
