"""Tables for the terminal, as plain text."""
