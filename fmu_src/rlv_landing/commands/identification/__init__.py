"""The command `rlv-landing identify`."""
