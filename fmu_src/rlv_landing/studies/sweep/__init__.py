"""Sweeps: studies of many landings, their rows of responses, and Sobol indices of these."""
