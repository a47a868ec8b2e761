"""The panel's node: its subscriptions, its requests, and the web server of its page."""
