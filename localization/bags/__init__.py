"""Recorded drives out of ROS bags: ROS 1, and ROS 2 as SQLite or MCAP."""
