"""What `hexarm new` asks: all measures of all kinds of machines."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from hexarm.new.reading import (
    ANGLE,
    PLACE,
    SIZE,
    Parse,
    height,
    number,
    numbers,
    one_of,
    table,
    words,
)
from hexarm.new.servos import SERVOS
from manipulator.errors import InvalidInput
from manipulator.formatting import did_you_mean, nearest, shown

Answers = Mapping[str, Any]


@dataclass(frozen=True)
class Question:
    """A measure: its key, what is asked, and how an answer is read (InvalidInput says why not).

    default is used for no answer; None where there must be one. rows: the names under which a
    person is asked for one row of a table at a time, with parse_row. choices: words and what
    they mean.
    """

    key: str
    text: str
    parse: Parse
    default: Any = None
    when: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    rows: tuple[str, ...] = ()
    parse_row: Parse | None = None
    choices: Mapping[str, str] = field(default_factory=dict)

    def is_asked(self, answers: Answers) -> bool:
        """Whether what was answered so far makes it a question."""
        return all(answers.get(key) in values for key, values in self.when.items())

    def may_be_asked(self, answers: Answers) -> bool:
        """Whether it may become one by what is not answered yet."""
        return all(answers.get(key, values[0]) in values for key, values in self.when.items())


KINDS = {
    'crank': 'six servos with horns and rods under a platform',
    'linear': 'six cylinders or linear servos under a platform (Gough-Stewart)',
    'rail': 'six struts on carriages that slide on rails (hexaglide, 6-PUS)',
    'arm': 'six joints in a row',
}
CIRCLES_OR_POINTS = {
    'circles': 'joints on two circles, by radii and angles',
    'coordinates': 'six points each, as measured or drawn',
}
FORMS = {
    'crank': {
        **CIRCLES_OR_POINTS,
        'paper': 'R, p, q, l, s of a hexagonal body (Prokopovich 2019)',
    },
    'linear': CIRCLES_OR_POINTS,
    'rail': CIRCLES_OR_POINTS,
    'arm': {
        'dh': 'a standard Denavit–Hartenberg table',
        'modified_dh': 'a modified one (Craig)',
        'urdf': 'a URDF file',
    },
}
SERVO_CHOICES = {
    **{
        name: f'{s.speed_deg_s:.0f} °/s, {s.torque_n_m:.2g} N·m ({s.note})'
        + ('' if s.pulse_us else ', on a bus')
        for name, s in SERVOS.items()
    },
    'other': 'another one with pulses; its numbers are asked for',
    'driver': 'drives that have a ROS 2 driver of their own',
}
LEGS = tuple(f'leg {k}' for k in range(1, 7))
JOINTS = tuple(f'joint {k}' for k in range(1, 7))
BY_ONE = 'one angle a for a, 120-a, 120+a, 240-a, 240+a, -a; or six'
CRANK, LINEAR, RAIL, ARM = ({'kind': (kind,)} for kind in KINDS)
PLATFORM = {'kind': ('crank', 'linear', 'rail')}
PUSHED = {'kind': ('linear', 'rail')}
CIRCLES = {**PLATFORM, 'given_by': ('circles',)}
POINTS = {'given_by': ('coordinates',)}
PAPER = {**CRANK, 'given_by': ('paper',)}
TABLES = {**ARM, 'given_by': ('dh', 'modified_dh')}
OTHER = {'servo': ('other',)}


def _choice(
    key: str, text: str, choices: Mapping[str, str], when: Mapping[str, Any], default: Any = None
) -> Question:
    return Question(key, text, one_of(choices), default, when, choices=choices)


def _rows(key: str, text: str, row: Parse, when: Mapping[str, Any], names: tuple[str, ...]) -> Any:
    return Question(key, text, table(row, len(names)), None, when, names, row)


POINT = numbers((3,), PLACE)
QUESTIONS: tuple[Question, ...] = (
    Question('description', 'What is it, in one line (for lists)?', words, ''),
    _choice('kind', 'What kind of machine?', KINDS, {}),
    *(_choice('given_by', 'Which measures are there?', forms, {'kind': (kind,)})
      for kind, forms in FORMS.items()),
    Question('base_radius_mm', "radius of the circle of the base's joints (of a crank: where the "
             "servo's axis meets the plane of the rod's end; of a rail: the strut's lower joint "
             'with the carriage at the beginning of its travel)', number(SIZE), when=CIRCLES),
    Question('base_angles_deg', f'their angles from the x axis: {BY_ONE}',
             numbers((1, 6), ANGLE), when=CIRCLES),
    Question('base_joint_height_mm', "height of those joints above the base's origin",
             number(PLACE), 0.0, CIRCLES),
    Question('platform_radius_mm', "radius of the circle of the platform's joints",
             number(SIZE), when=CIRCLES),
    Question('platform_angles_deg', f'their angles from the x axis: {BY_ONE}',
             numbers((1, 6), ANGLE), when=CIRCLES),
    Question('platform_joint_height_mm', "from the platform's origin to its joints, towards the "
             'base', number(PLACE), 0.0, CIRCLES),
    _rows('base_joints_mm', "the joints on the base, x y z (of a crank: where the servo's axis "
          "meets the plane of the rod's end; of a rail: the strut's lower joint with the carriage "
          'at the beginning of its travel)', POINT, {**PLATFORM, **POINTS}, LEGS),
    _rows('platform_joints_mm', "the joints on the platform, x y z from the platform's origin",
          POINT, {**PLATFORM, **POINTS}, LEGS),
    Question('body_radius_mm', 'R: from the axis to each side of the body', number(SIZE),
             when=PAPER),
    Question('crank_offset_mm', 'p: how far the horns are outside that', number(PLACE),
             when=PAPER),
    Question('crank_shift_mm', "q: the servos' axes from the middle of a side, along it",
             number(PLACE), when=PAPER),
    Question('joint_inset_mm', "l: how far the platform's joints are inside R", number(PLACE),
             when=PAPER),
    Question('joint_shift_mm', "s: the platform's joints from the middle of a side, along it",
             number(PLACE), when=PAPER),
    Question('horn_length_mm', "horn: from the servo's axis to the rod's end", number(SIZE),
             when=CRANK),
    Question('horn_direction_deg', 'where a level horn points, seen from above, from the x axis: '
             f'{BY_ONE}', numbers((1, 6), ANGLE),
             when={**CRANK, 'given_by': ('circles', 'coordinates')}),
    Question('rod_length_mm', 'rod or strut: between its joints', number(SIZE),
             when={'kind': ('crank', 'rail')}),
    _choice('rail_direction', 'Where do the carriages go, from the beginning of their travel?',
            {'up': 'straight up', 'down': 'straight down',
             'out': 'level, away from the middle of the base', 'in': 'level, towards it',
             'own': 'each in a direction of its own'}, RAIL),
    _rows('rail_directions', 'where each carriage goes, x y z, of any length', POINT,
          {**RAIL, 'rail_direction': ('own',)}, LEGS),
    _choice('carriages', 'Where is a carriage at home, along its rail?',
            {'behind': 'not yet past its joint on the platform', 'ahead': 'past it',
             'auto': 'where it is nearer to the middle of its travel'}, RAIL, 'auto'),
    Question('retracted_mm', 'cylinder, retracted: between its joints', number(SIZE), when=LINEAR),
    Question('stroke_mm', 'stroke of the cylinder, travel of the carriage', number(SIZE),
             when=PUSHED),
    Question('cylinder_speed_mm_s', 'its speed without load', number(SIZE), when=PUSHED),
    Question('cylinder_force_n', 'its force in N', number(SIZE), 40.0, PUSHED),
    _choice('cylinder_input', 'What moves the cylinders or carriages?',
            {'pulses': 'RC pulses: linear servos', 'driver': 'a ROS 2 driver of their own'},
            PUSHED, 'pulses'),
    Question('pulse_us', 'pulses at the ends of the stroke', numbers((2,), (100.0, 30000.0)),
             [1000.0, 2000.0], {**PUSHED, 'cylinder_input': ('pulses',)}),
    Question('home_height_mm', 'height of the platform at home (below the base: negative); auto: '
             'above it, with level horns, or cylinders or carriages at half their stroke',
             height, 'auto', PLATFORM),
    _rows('dh_table', 'a (mm), alpha (°), d (mm), and the offset of θ (°) if there is one',
          numbers((3, 4), PLACE), TABLES, JOINTS),
    Question('tool_mm', 'from the last frame to the tool, along its z', number((0.0, 1e6)), 0.0,
             TABLES),
    Question('joint_ranges_deg', 'travel of the joints: two numbers for all, or six pairs',
             numbers((2, 12), (-360000.0, 360000.0)), when=TABLES),
    Question('home_deg', 'six joint angles at home; auto: chosen, not near a singular posture',
             lambda v: 'auto' if str(v).strip().lower() == 'auto' else numbers((6,), ANGLE)(v),
             'auto', TABLES),
    Question('urdf', 'path of the URDF file (its meshes, too: hexarm import)', words,
             when={**ARM, 'given_by': ('urdf',)}),
    Question('tip', 'its last link; auto: chosen', words, 'auto',
             {**ARM, 'given_by': ('urdf',)}),
    _choice('servo', 'Which servos?', SERVO_CHOICES, CRANK),
    _choice('servo', 'Which servos, in all joints?', SERVO_CHOICES, TABLES, 'driver'),
    Question('servo_speed_deg_s', 'speed of the joints without load, °/s', number(SIZE),
             when={'servo': ('other', 'driver')}),
    Question('servo_torque_n_m', 'torque at standstill, N·m', number((1e-6, 1e6)), when=OTHER),
    Question('servo_travel_deg', 'travel of the servo', number((1.0, 720.0)), 180.0, OTHER),
    Question('servo_pulse_us', 'pulses at the ends of that travel',
             numbers((2,), (100.0, 30000.0)), [500.0, 2500.0], OTHER),
    Question('horn_travel_deg', 'how far each horn may turn, in all (what the servo allows, less '
             'where it would hit something)', number((1.0, 360.0)), 180.0, CRANK),
    Question('horn_at_middle_deg', 'angle of the horn above level in the middle of that travel; '
             'auto: where it is at home', height, 'auto', CRANK),
    Question('joint_swing_deg', "how far the ball joints of a rod, strut or cylinder swing each "
             'way from home', number((1.0, 90.0)), 30.0, PLATFORM),
    Question('platform_g', 'mass of the platform in g, for simulations', number(SIZE), 100.0,
             PLATFORM),
    Question('payload_g', 'mass of what it carries in g', number((0.0, 1e9)), 0.0, PLATFORM),
)  # fmt: skip


def checked(given: Mapping[str, Any]) -> dict[str, Any]:
    """All measures of an answers file; InvalidInput names everything that is wrong or missing."""
    answers: dict[str, Any] = {}
    problems: list[str] = []
    for question in QUESTIONS:
        if question.key in answers or not question.is_asked(answers):
            continue
        value = given.get(question.key, question.default)
        try:
            if value is None:
                choices = f' {", ".join(question.choices)}' if question.choices else ''
                raise InvalidInput(f'missing: {question.text}{choices}')
            answers[question.key] = question.parse(value)
        except InvalidInput as error:
            problems.append(f'{question.key}: {error}')
    known = {question.key for question in QUESTIONS}
    for key in given:
        if key not in known:
            near = nearest(str(key), sorted(known))
            problems.append(f'{shown(key)}: unknown{did_you_mean(near)}')
        elif not any(q.may_be_asked(answers) for q in QUESTIONS if q.key == key):
            problems.append(f'{key}: not a measure of this kind of machine')
    if problems:
        raise InvalidInput('\n'.join(problems))
    return answers
