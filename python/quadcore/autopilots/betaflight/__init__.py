"""Bridge to Betaflight's SITL (software in the loop) program."""
