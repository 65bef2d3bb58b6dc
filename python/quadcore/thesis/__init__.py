"""The thesis: the mathematical model of its chapter 2, and the validation of its chapter 6."""
