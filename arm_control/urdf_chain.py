"""The six axes from base to tip of a URDF, fixed joints folded in: in base axes at zero."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from arm_control.chain import JOINTS, Chain
from arm_control.geometry import other_axes
from arm_control.urdf_file import Inertial, UrdfJoint, UrdfRobot, Visual
from manipulator.errors import ConfigError
from manipulator.formatting import shown
from manipulator.pose import Pose

TURNING = ('revolute', 'continuous')
TOOL = 'tool0'
"""The tip where several links could be it: what ROS-Industrial calls the mounting face."""
FEW = 3
"""Axes before the joints branch, with fewer of which it is no arm: two arms, a torso, legs."""
MOST_NAMED = 12


@dataclass(frozen=True, eq=False)
class UrdfArm:
    """base and tip are links; joints, base first, have limits of their own.

    bodies are what each joint carries up to the next, in base axes at zero; None where the file
    has no mass for any of it. visuals are the meshes of the base and of what each joint carries,
    likewise.
    """

    base: str
    tip: str
    joints: tuple[UrdfJoint, ...]
    chain: Chain
    bodies: tuple[Inertial | None, ...]
    visuals: tuple[tuple[Visual, ...], ...]


def arm_of(robot: UrdfRobot, base: str | None = None, tip: str | None = None) -> UrdfArm:
    """The arm between two links; by default from the root to tool0, or to the end of the arm.

    ConfigError names loops, joints that do not turn by themselves, and the candidates where the
    base or the tip is not clear.
    """
    tree = _Tree(robot)
    base = tree.root() if base is None else tree.link('base', base)
    if tip is None:
        tip = tree.only_tip(base)
    path = tree.path(base, tree.link('tip', tip))
    tree.check(base, tip)
    joints = tuple(joint for joint in path if joint.kind in TURNING)
    poses = tree.poses(base)
    frames = [poses[joint.child] for joint in joints]
    axes = [frame.rotation @ joint.axis for frame, joint in zip(frames, joints, strict=True)]
    chain = Chain(np.array(axes), np.array([frame.position for frame in frames]), poses[tip])
    bodies, visuals = tree.bodies(base, joints), tree.visuals(base, joints)
    return UrdfArm(base, tip, joints, chain, bodies, visuals)


class _Tree:
    """The links of a robot, by the joint above each."""

    def __init__(self, robot: UrdfRobot) -> None:
        """ConfigError for a link under two joints, and for links in a circle."""
        self.robot = robot
        self.above: dict[str, UrdfJoint] = {}
        for joint in robot.joints:
            other = self.above.setdefault(joint.child, joint)
            if other is not joint:
                both = f'{shown(other.name)} and {shown(joint.name)}'
                raise ConfigError(
                    [f'link {shown(joint.child)} is below two joints, {both}: a loop']
                )
        self.below: dict[str, list[UrdfJoint]] = {}
        for joint in robot.joints:
            self.below.setdefault(joint.parent, []).append(joint)
        roots = [link for link in robot.bodies if link not in self.above]
        reached = {link for root in roots for link in self.order(root)}
        circle = next((link for link in robot.bodies if link not in reached), None)
        if circle is not None:
            raise ConfigError([f'link {shown(circle)} is below itself: a loop'])
        self.roots = roots

    def order(self, base: str) -> list[str]:
        """Every link from base on, parents before children."""
        found = [base]
        for link in found:
            found += [joint.child for joint in self.below.get(link, [])]
        return found

    def root(self) -> str:
        """The base; ConfigError names the roots where there is not one."""
        if not self.roots:
            raise ConfigError(['there is no link'])
        if len(self.roots) != 1:
            raise ConfigError([f'the base is not clear, --base: {_listed(self.roots)}'])
        return self.roots[0]

    def link(self, role: str, name: str) -> str:
        """The name; ConfigError for no link of the file."""
        if name not in self.robot.bodies:
            known = _listed(list(self.robot.bodies))
            raise ConfigError([f'{role} {shown(name)} is no link of the file, which has {known}'])
        return name

    def path(self, base: str, tip: str) -> list[UrdfJoint]:
        """The joints from base to tip; ConfigError where the tip is not below the base."""
        path, link = list[UrdfJoint](), tip
        while link != base:
            if link not in self.above:
                raise ConfigError([f'tip {shown(tip)} is not below base {shown(base)}'])
            path.append(self.above[link])
            link = path[-1].parent
        return path[::-1]

    def check(self, base: str, tip: str) -> None:
        """ConfigError unless six joints turn between them, each by itself, and nothing slides."""
        path = self.path(base, tip)
        for joint in path:
            if joint.kind not in (*TURNING, 'fixed'):
                raise ConfigError(
                    [f'joint {shown(joint.name)} is {joint.kind}, an arm has joints that turn']
                )
            if joint.mimics:
                mimicked = f'mimics {shown(joint.mimics)}, an arm has a drive for each joint'
                raise ConfigError([f'joint {shown(joint.name)} {mimicked}'])
        axes = self._axes(base, tip)
        if axes != JOINTS:
            place = f'from base {shown(base)} to tip {shown(tip)}'
            hint = '; where a gripper follows, --tip LINK' if axes > JOINTS else ''
            raise ConfigError([f'{place}: {other_axes(axes)}{hint}'])

    def only_tip(self, base: str) -> str:
        """tool0, or else the end of the arm; ConfigError where that is not clear, or not six axes.

        The arm goes on where one joint turns, and ends at what carries none or several: fingers.
        After six axes a joint that others mimic drives fingers, too.
        """
        links = self.order(base)
        named = [link for link in links if link == TOOL or link.endswith((f'_{TOOL}', f'/{TOOL}'))]
        if len(named) == 1:
            return named[0]
        body, axes = self.body(base), 0
        while len(after := self.carried(body)) == 1 and after[0].kind in TURNING:
            if axes >= JOINTS and any(j.mimics == after[0].name for j in self.robot.joints):
                break
            body, axes = self.body(after[0].child), axes + 1
        if axes == JOINTS:
            last = [link for link in body if not self._goes_on(link, body)]
            if len(last) == 1:
                return last[0]
            raise ConfigError([f'the tip is not clear, --tip: {_listed(last)}'])
        fitting = [link for link in links if self._is_arm(base, link)]
        if fitting and axes < FEW:
            raise ConfigError([f'the tip is not clear, --tip: {_listed(fitting)}'])
        if axes < FEW or not after:
            end = max(links, key=lambda link: (self._axes(base, link), len(self.path(base, link))))
        else:
            is_arm = len(after) == 1 and self._carries_axes(after[0].child)
            end = after[0].child if is_arm else body[0]
        self.check(base, end)
        raise ConfigError([f'the tip is not clear, --tip: {_listed(fitting)}'])

    def body(self, link: str) -> list[str]:
        """The link and those on fixed joints below it."""
        found = [link]
        for one in found:
            found += [j.child for j in self.below.get(one, []) if j.kind == 'fixed']
        return found

    def carried(self, body: Sequence[str]) -> list[UrdfJoint]:
        """The joints of a body that move by themselves."""
        below = (joint for link in body for joint in self.below.get(link, []))
        return [joint for joint in below if joint.kind != 'fixed' and not joint.mimics]

    def _goes_on(self, link: str, body: Sequence[str]) -> bool:
        return any(joint.child in body for joint in self.below.get(link, []))

    def _carries_axes(self, link: str) -> bool:
        """Whether anything turns by itself behind the link, so that it is part of the arm."""
        behind = (joint for link in self.order(link) for joint in self.below.get(link, []))
        return any(joint.kind in TURNING and not joint.mimics for joint in behind)

    def _axes(self, base: str, tip: str) -> int:
        return sum(joint.kind in TURNING for joint in self.path(base, tip))

    def _is_arm(self, base: str, tip: str) -> bool:
        try:
            self.check(base, tip)
        except ConfigError:
            return False
        return True

    def poses(self, base: str) -> dict[str, Pose]:
        """T_base_link of every link below the base, at zero."""
        poses = {base: Pose.identity()}
        for link in self.order(base)[1:]:
            poses[link] = poses[self.above[link].parent] @ self.above[link].origin
        return poses

    def bodies(self, base: str, joints: Sequence[UrdfJoint]) -> tuple[Inertial | None, ...]:
        """What each joint carries up to the next, with all that hangs on it, at zero."""
        poses, found = self.poses(base), list[Inertial | None]([None] * len(joints))
        for link, owner in self._owners(base, joints).items():
            body = self.robot.bodies[link]
            if owner >= 0 and body is not None:
                placed, before = body.moved(poses[link]), found[owner]
                found[owner] = placed if before is None else before.joined(placed)
        return tuple(found)

    def visuals(self, base: str, joints: Sequence[UrdfJoint]) -> tuple[tuple[Visual, ...], ...]:
        """Of the base, without what moves on it beside the arm, and of what each joint carries."""
        poses, standing = self.poses(base), self.body(base)
        found: list[list[Visual]] = [[] for _ in range(len(joints) + 1)]
        for link, owner in self._owners(base, joints).items():
            if owner >= 0 or link in standing:
                found[owner + 1] += [
                    replace(visual, place=poses[link] @ visual.place)
                    for visual in self.robot.visuals[link]
                ]
        return tuple(map(tuple, found))

    def _owners(self, base: str, joints: Sequence[UrdfJoint]) -> dict[str, int]:
        """By link from base on the index of the joint that carries it, -1 for none."""
        moving, owners = {joint.child: i for i, joint in enumerate(joints)}, {base: -1}
        for link in self.order(base)[1:]:
            owners[link] = moving.get(link, owners[self.above[link].parent])
        return owners


def _listed(links: Sequence[str]) -> str:
    more = ', …' if len(links) > MOST_NAMED else ''
    return ', '.join(link[:80] for link in links[:MOST_NAMED]) + more
