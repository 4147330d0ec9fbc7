"""Verification: a log beside a repetition of its run, value by value."""
