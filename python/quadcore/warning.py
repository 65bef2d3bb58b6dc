"""What is allowed but was perhaps not meant."""


class QuadcoreWarning(UserWarning):
    """What is allowed but was perhaps not meant."""
