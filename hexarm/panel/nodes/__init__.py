"""The panel's node: what it hears, what it asks for, and the web server of its page."""
