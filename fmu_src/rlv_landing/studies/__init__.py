"""Studies of many landings: sweeps, their Sobol indices, and stability envelopes."""
