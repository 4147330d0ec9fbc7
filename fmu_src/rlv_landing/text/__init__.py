"""Numbers with units in text, text files, terminals, and files that are written whole."""
