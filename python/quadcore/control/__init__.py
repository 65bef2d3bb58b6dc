"""Controllers: the built-in laws, their gains and references, and the inner loop."""
