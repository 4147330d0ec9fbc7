"""`python -m rlv_landing.cli`: the command line."""

from . import main

main()
