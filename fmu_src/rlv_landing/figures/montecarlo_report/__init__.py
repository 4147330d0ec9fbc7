"""The report of a Monte Carlo, one page."""
