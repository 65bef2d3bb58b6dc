"""What every study of many flights is made of.

`axes` span a grid of what is varied, a `variation` makes a `FlightPlan` of each of its points,
`control` says what commands it, the `executor` flies them within a `time_limit`, `metrics`
measures how far they are apart, and a `table` is what is kept. Comparison, evaluation, sweeps and
validation say what to fly and what to tell.
"""
