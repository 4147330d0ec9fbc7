"""MCAP logs: recording, reading, recovery, repetition, comparison and export."""
