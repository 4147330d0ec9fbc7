"""Scalars and curves that a user measured of landings, as targets of an identification."""
