"""Builds the FMU: slave, package, compiled core, binary, description, documentation."""
