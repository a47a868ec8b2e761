"""The nodes of serial_bridge: messages in, what `driver.py` does with them, messages out."""
