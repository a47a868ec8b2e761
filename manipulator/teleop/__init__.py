"""What a joystick's twist means: one file per jog mode, and what all modes share."""
