"""Writes a log: a thread compresses and writes what a landing records."""
