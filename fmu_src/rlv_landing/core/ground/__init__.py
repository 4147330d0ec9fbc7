"""Laws of the ground under a footpad: a file each, and `kinds.py`, which chooses among them."""
