"""Laws of struts: a file each, and `kinds.py`, which chooses among them."""
