"""The ROS 2 side of rlv-landing: FMU runner, landing node, MCAP logs, replay and viewer.

Importing this package needs neither ROS 2 nor FMPy nor MCAP. Each module imports what it uses.
"""
