"""What a user measured of landings: scalars and curves, as targets of an identification."""
