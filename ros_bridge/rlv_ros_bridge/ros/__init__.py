"""Start and stop of ROS 2, signals, executors, and the private parts of rclpy that are used."""
