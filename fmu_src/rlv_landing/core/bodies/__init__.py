"""Bodies on legs, each a `System` that solvers integrate."""
