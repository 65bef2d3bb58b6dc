"""Sweeps: thousands of flights from one description, on whatever executes them.

A `design` says which points of the axes are flown, a `plan` makes a `spec` of each row, which can
be flown anywhere, `places` fly them, `rows` keeps what comes back, and `sweep` puts that together;
`sensitivity`, `again` and `pictures` tell what it means, and `output` writes that.
"""
