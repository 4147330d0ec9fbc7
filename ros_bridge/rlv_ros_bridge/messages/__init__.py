"""The messages of a landing: topics, fields, and how they are filled, packed and read back."""
