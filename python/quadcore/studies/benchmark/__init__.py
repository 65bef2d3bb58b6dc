"""The benchmark: a fixed, versioned set of flights for the comparison of controllers.

`definition` reads a version, `flights` simulates it, `scores` summarises the categories, `record`
describes controllers and machine, and `output` writes the files.
"""
