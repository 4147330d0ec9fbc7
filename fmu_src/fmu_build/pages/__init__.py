"""The documentation in the FMU: page, drawing, icon."""
