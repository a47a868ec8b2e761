"""`hexarm new`: a machine file of the measures that people have."""
