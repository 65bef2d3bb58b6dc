"""Controllers, their gains, reference trajectories and the inner loop."""
