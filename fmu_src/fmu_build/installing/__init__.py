"""What is done for an installation: what `make` needs, and what wheels carry."""
