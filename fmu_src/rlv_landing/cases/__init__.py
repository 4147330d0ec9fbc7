"""Landings of others, or in closed form, each in a file, beside ours."""
