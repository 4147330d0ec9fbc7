"""Stability envelopes: the boundary between stable and lost landings in two quantities."""
