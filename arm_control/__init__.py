"""Serial six-axis arms."""
