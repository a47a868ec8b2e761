"""The serial link to the board: protocol, calibration, host session, port, and a fake board."""
