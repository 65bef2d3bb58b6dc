"""Chapter 6.1 of the thesis: comparison of plant and mathematical model, split by cause."""

from .damping import Damping
from .drags import DRAGS
from .error_budget import Chain, Link
from .experiment import MODEL, TERMS, Case, Experiment, Flight
from .states import STATES, compare_states, extract_states
from .study import Row, Study, run_study

__all__ = [
    "DRAGS",
    "MODEL",
    "STATES",
    "TERMS",
    "Case",
    "Chain",
    "Damping",
    "Experiment",
    "Flight",
    "Link",
    "Row",
    "Study",
    "compare_states",
    "extract_states",
    "run_study",
]
