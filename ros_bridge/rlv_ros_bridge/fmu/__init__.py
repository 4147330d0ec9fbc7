"""The FMU as the bridge uses it: unpacking, stepping, identity of its build."""
