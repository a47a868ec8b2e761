"""What the person at the terminal reads while walking through the servos."""

from bridge.protocol import Mode
from bridge.servo_walk import ServoWalk, Stage

HELP = """\
 →/← or d/a  longer, shorter pulse     +/-  step    s  skip    b  this servo again
 SPACE       STOP (c clears it)        q    to the end         Ctrl-C  servos off, nothing kept

"""
CONSENT = """\
Take rods or load off the servos, or keep a hand at the plug: the first pulse moves each servo to
its centre at full speed, one after the other. The graph (hexarm up) must not run meanwhile.
{found}ENTER energises {count} servos, q leaves. """
FOUND = {
    Mode.STOPPED: 'The board is stopped; energising clears that.\n',
    Mode.FAULT: 'The board has a fault; energising clears that.\n',
    Mode.ARMED: 'The servos have power already and stay where they are.\n',
    Mode.HOLDING: 'The servos have power already and stay where they are.\n',
}
"""What is said before anything is energised, by the mode that the board is found in."""

POSITIVE = {
    'rotary_hexapod': ' (the crank turns from its tangent upwards)',
    'linear_hexapod': ' (the leg grows longer)',
    'serial_arm': ' (a right-hand turn about the axis)',
}
"""Which way is positive, by the kind of machine."""


def question(walk: ServoWalk, positive: str) -> str:
    """What is asked in the present stage."""
    servo, unit = walk.servo, 'mm' if walk.servo.is_linear else '°'
    centre = servo.centre_mm if servo.centre_mm is not None else servo.centre_deg
    low, high = servo.pulse_range_us
    told = {
        Stage.DIRECTION: f'jog it. Does a longer pulse (→) move it towards positive{positive}? '
        'y or n',
        Stage.CENTRE: f'bring it to {centre:g} {unit} and press ENTER; '
        'or bring it anywhere and type =ANGLE ENTER',
        Stage.SCALE: 'bring it to a second angle that you can read and type =ANGLE ENTER; '
        's keeps the scale',
        Stage.RANGE: f'pulses {low:g} to {high:g} µs: where it must not go so far, jog to the '
        'end and press [ or ]; ENTER goes on',
        Stage.RETURN: 'goes back to its centre',
        Stage.REVIEW: 'w: servos off and write, q: servos off and leave',
    }.get(walk.stage, '')
    name = 'end' if walk.stage is Stage.REVIEW else f'{servo.name}, {walk.stage.value}'
    return f'{name}: {told}\n'


def status(walk: ServoWalk, stopped: bool, seen: str) -> str:
    """The line that is rewritten all the time."""
    typed = '' if walk.typed is None else f'  ={walk.typed}_'
    notice = 'STOPPED, c clears it' if stopped else walk.notice
    told = f'  {notice}' if notice else ''
    return f' {walk.servo.name}  {walk.pulse:7.1f} µs  step {walk.step:g}{seen}{typed}{told}'
