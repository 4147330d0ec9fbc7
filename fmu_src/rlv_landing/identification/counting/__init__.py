"""The search that counts the scalars within 5, 10 and 20 %."""
