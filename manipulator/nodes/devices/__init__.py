"""Input devices of a person: gamepad, keyboard, and what they publish."""
