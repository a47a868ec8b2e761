"""A machine's whole chain in one process and in simulated time, without ROS.

Processes hand values to one another over links of a chosen delay, depth and loss; the test lets
time pass. What the nodes do around the core is done here again, in few lines (supervisor.py,
kinematics.py, bridge.py): where the two differ, the node is right, and the difference a fault.
"""
