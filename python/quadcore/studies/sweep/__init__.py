"""Sweeps: many flights over a grid or random samples of parameters.

`plan` describes the rows, and `row_spec` makes each row independent of the process that runs it.
`execution` runs the rows on local processes or an executor, and `row_file` stores them.
`sensitivity` analyses the results, and `output` and `plots` write them.
"""
