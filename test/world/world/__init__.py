"""A machine's whole chain in one process and in simulated time, without ROS.

Processes hand values to one another over links of a chosen delay, depth and loss; the test lets
time pass. The core is the real one; what the nodes do around it is done here again, in few lines
(supervisor.py, kinematics.py, bridge.py): where the two differ, the node is right, and the
difference a fault.
"""
