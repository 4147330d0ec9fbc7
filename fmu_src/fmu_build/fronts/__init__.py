"""The front of an FMU: its identity in C, and fronts that were compiled before."""
