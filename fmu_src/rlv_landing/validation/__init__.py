"""Validation: landings beside the paper and measured curves, and the audit of conservation laws."""
