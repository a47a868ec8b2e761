"""What `hexarm demo` shows of both machines."""
