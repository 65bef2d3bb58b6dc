"""Simulations of a single vehicle or a batch: commands, flights, logs and scenarios."""
