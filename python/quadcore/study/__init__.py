"""What every study of many flights is made of.

`axes` span a grid of what is varied, each of its points is a `FlightPlan`, the `executor` flies
them, `metrics` measures how far they are apart, and a `table` is what is kept. Comparison and
validation say what to fly and what to tell.
"""
