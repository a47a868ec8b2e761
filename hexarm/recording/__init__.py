"""Recordings of a machine's topics: MCAP files, written from ROS and read without it."""
