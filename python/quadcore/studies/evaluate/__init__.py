"""How well controllers fly: every combination of what flies, measured, with intervals and margins.

`plan` says what is flown, `flights` flies one, `measures` and `step_response` look at it,
`intervals` sums over seeds, `robustness` searches for what a controller forgives, and `evaluate`
puts that together; `output` and `pictures` tell it.
"""
