"""What every layer needs: checks of arguments, files, interrupts, warnings, rotations."""
