"""What stands behind `hexarm calibrate`: screens, files and the serial line."""
