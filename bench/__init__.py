"""What is measured, and against what: `python -m bench` runs everything and prints one table."""
