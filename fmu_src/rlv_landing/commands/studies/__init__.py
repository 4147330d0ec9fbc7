"""The commands of studies: sweeps, Sobol indices, envelopes, Monte Carlo."""
