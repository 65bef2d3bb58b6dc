"""Bridge to PX4's SITL program."""
