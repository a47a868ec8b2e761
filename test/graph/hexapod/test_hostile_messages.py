"""Messages that no honest sender would send, on every topic that any node listens to."""

import importlib
import itertools
import math
from array import array

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
from nav_msgs.srv import GetPlan
from rcl_interfaces.msg import Log
from sensor_msgs.msg import JointState

from hexarm.machines import load
from manipulator.errors import ManipulatorError
from manipulator.nodes.qos import LATCHED, MEASUREMENT
from manipulator.pose import Pose

pytestmark = pytest.mark.graph

NODES = (
    'trajectory',
    'ik',
    'pose',
    'serial_bridge',
    'serial_bridge_stop',
)
OURS = '/hexapod/'
KINEMATICS = load('robocake').kinematics
AT_HOME = KINEMATICS.inverse(KINEMATICS.home)
BAD_FLOATS = (math.nan, math.inf, -1e308)
BAD_TEXT = 'x' * 50_000
LONGEST_LINE = 1000


def base_message(kind):
    """One that would do nothing: joints and poses at home, zeros elsewhere."""
    message = kind()
    if kind is JointState:
        message.name, message.position = list(KINEMATICS.joint_names), AT_HOME.tolist()
    if kind is PoseStamped:
        message.pose.position.z = float(KINEMATICS.home.position[2])
    if kind is Path:
        message.poses = [base_message(PoseStamped)]
    return message


def leaves(message):
    """(object, field, value) of every number and text in a message, through all its parts."""
    for field in message.get_fields_and_field_types():
        value = getattr(message, field)
        if hasattr(value, 'get_fields_and_field_types'):
            yield from leaves(value)
        elif isinstance(value, list) and value and not isinstance(value[0], str):
            for part in value:
                yield from leaves(part)
        else:
            yield message, field, value


def spoilt(kind):
    """Messages of a kind, each with one field that cannot be."""
    for k in range(len(list(leaves(base_message(kind))))):
        for bad in range(3):
            message = base_message(kind)
            owner, field, value = list(leaves(message))[k]
            if spoil(owner, field, value, bad):
                yield message


def spoil(owner, field, value, bad):
    """Whether there is such a thing as bad value number `bad` of a field."""
    if isinstance(value, bool | bytes):
        return False
    if isinstance(value, float):
        setattr(owner, field, BAD_FLOATS[bad])
    elif isinstance(value, str) and bad == 0:
        setattr(owner, field, BAD_TEXT)
    elif isinstance(value, int) and field == 'sec':
        setattr(owner, field, (2**31 - 1, -(2**31), 1)[bad])
    elif field == 'name' and isinstance(value, list):
        owner.name = ([BAD_TEXT, *value[1:]], [], [f'j{i}' for i in range(10_000)])[bad]
    elif isinstance(value, array) and value.typecode == 'd':
        numbers = list(value)
        worse = ([math.nan] * max(len(numbers), 1), numbers[:-1], [0.0] * 10_000)
        setattr(owner, field, worse[bad])
    else:
        return False
    return True


def is_discovered(user, node, interfaces):
    """Whether the graph names the node and, by now, every topic that it is said to listen to."""
    if (node, OURS.rstrip('/')) not in user.node.get_node_names_and_namespaces():
        return False
    received = user.node.get_subscriber_names_and_types_by_node(node, OURS.rstrip('/'))
    said = {OURS + name for kind, name in interfaces.documented(node) if kind == 'in'}
    return said <= {topic for topic, _ in received}


@pytest.fixture(scope='module')
def senders(user, interfaces):
    """A publisher for every topic that a node of ours listens to, matched with its listeners."""
    found = {}
    user.reach_home()
    for node in NODES:
        user.wait(f'all of {node}', lambda n=node: is_discovered(user, n, interfaces), 30.0)
        ask = user.node.get_subscriber_names_and_types_by_node
        for topic, (name, *_) in ask(node, OURS.rstrip('/')):
            if not topic.startswith(OURS) or topic in found:
                continue
            package, _, kind = name.split('/')
            kind = getattr(importlib.import_module(f'{package}.msg'), kind)
            found[topic] = kind, user.node.create_publisher(kind, topic, LATCHED)
    for topic, (_, publisher) in found.items():
        user.wait(topic, lambda p=publisher: p.get_subscription_count() > 0, 10.0)
    return found


def test_every_topic_that_the_documents_name_is_tried(senders):
    names = {topic.removeprefix(OURS) for topic in senders}
    wanted = {'goal_pose', 'goal_path', 'pose', 'joint_states', 'setpoint', 'joint_command'}
    wanted |= {'cmd_vel', 'cmd_vel/joy', 'speed_override', 'pivot', 'tool', 'look_at', 'jog_mode'}
    assert names >= wanted | {'machine_state', 'emergency_stop', 'joint_table'}


def test_no_field_of_any_message_kills_a_node_moves_the_machine_or_fills_the_log(senders, user):
    lines, strays = [], []
    subscribe = user.node.create_subscription
    log = subscribe(Log, '/rosout', lambda m: lines.append(len(m.msg)), 100)
    order = [load('robocake').kinematics.joint_names.index(n) for n in KINEMATICS.joint_names]
    truth = subscribe(
        JointState,
        'true_joint_states',
        lambda m: strays.append(np.abs(np.array(m.position)[order] - AT_HOME).max()),
        MEASUREMENT,
    )
    user.wait('home', lambda: strays and strays[-1] < 0.03)
    strays.clear()
    sent = 0
    for kind, publisher in senders.values():
        for message in spoilt(kind):
            publisher.publish(message)
            sent += 1
            user.spin(0.004)
    user.spin(0.5)
    user.node.destroy_subscription(log)
    user.node.destroy_subscription(truth)
    assert sent > 200
    assert max(strays) < 0.03
    assert max(lines) < LONGEST_LINE


def asked_until_its_clock_is_believed(ask, user):
    """A while of stamps that agree, where one from the future was believed."""
    for _ in range(3):
        try:
            return ask()
        except ManipulatorError as error:
            assert 's old' in str(error)
            user.spin(0.1)
    return ask()


def test_the_machine_works_again_at_once(senders, user):
    for _, publisher in senders.values():
        user.node.destroy_publisher(publisher)
    senders.clear()
    user.persist(user.disable)
    user.make_ready()
    user.reach_home()
    goal = Pose.from_xyz_rpy((0.003, 0.0, 0.043))
    path = Pose(np.array([goal.position, KINEMATICS.home.position]), np.array([goal.rotation] * 2))
    for ask in (lambda: user.reach(goal), lambda: user.persist(lambda: user.follow(path))):
        asked_until_its_clock_is_believed(ask, user)
        assert user.motion('result') == 'reached'
    assert all(len(v.value) < LONGEST_LINE for d in user.diagnostics.values() for v in d.values)


def test_absurd_requests_for_a_plan_are_answered_with_none(enabled):
    client = enabled.node.create_client(GetPlan, 'trajectory/plan')
    enabled.wait('the service', client.service_is_ready)
    for bad, part in itertools.product((*BAD_FLOATS, BAD_TEXT), ('start', 'goal')):
        request = GetPlan.Request(start=base_message(PoseStamped), goal=base_message(PoseStamped))
        pose = getattr(request, part)
        if isinstance(bad, str):
            pose.header.frame_id = bad
        else:
            pose.pose.position.x = bad
        assert len(enabled.answer_of(client, request, 'an answer').plan.poses) == 0
    enabled.node.destroy_client(client)
