"""The parts of `hexarm calibrate`: screens, files and the serial line."""
