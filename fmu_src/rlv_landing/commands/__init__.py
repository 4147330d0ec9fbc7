"""The commands of `rlv-landing`, a file each, and the options that they share."""
