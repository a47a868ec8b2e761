"""ROS nodes, written once for both kinds of machine."""
