"""The ROS 2 side of rlv-landing: steps the FMU, publishes the landing, records it to MCAP and plays
it back.

Importing this package needs neither ROS 2 nor FMPy nor MCAP; each module imports what it works
with.
"""
