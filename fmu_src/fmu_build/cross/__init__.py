"""Compiled cores for other platforms, made on this machine."""
