"""Studies of many flights: evaluation, comparison, sweep, tuning and fit.

`axes` and `design` define the points, `variation` makes a `FlightPlan` of each point,
`control_setup` adds controllers and references, and `cases` combines all of them. The `executor`
runs the flights within a `time_limit`. `tracking_metrics` and `flight_differences` evaluate them,
and `table` writes the results.
"""
