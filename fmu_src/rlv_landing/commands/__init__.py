"""The commands of `rlv-landing` that have a file of their own, and the options that commands share."""
