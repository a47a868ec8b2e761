"""A machine's whole chain in one process and in simulated time, without ROS.

Processes hand values to one another over links of a chosen delay, depth and loss; the test lets
time pass. The core is the nodes' own; what the nodes and the link's thread do around it is done
here again, in few lines: where the two differ, the node is right, and the difference a fault.
"""
