"""Integration methods for a `System`; none of them knows what it integrates."""
