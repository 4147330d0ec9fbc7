"""The bridge's commands on the command line."""
