"""Replay of a log: selection, clock, keyboard, and the node that publishes."""
