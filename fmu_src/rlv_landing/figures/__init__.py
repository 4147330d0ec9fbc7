"""Figures, animations and the validation report."""
