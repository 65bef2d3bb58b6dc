"""Evaluation of controllers: tracking metrics, confidence intervals and margins.

`plan` lists the flights, `evaluate` runs them, `seed_statistics` and `intervals` summarise the
seeds, `margins` searches for gain and delay margins, and `output` and `plots` write the results.
"""
