"""A machine's whole chain in one process and in simulated time, without ROS.

Processes hand values to one another over links of a chosen delay, depth and loss; the test lets
time pass. Supervisor and kinematics are the nodes' own core. What the bridge's node does around
its core is done here again, in few lines (bridge.py): where the two differ, the node is right,
and the difference a fault.
"""
