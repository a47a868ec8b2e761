"""A machine as MuJoCo simulates it: targets in, positions, rates and efforts out."""

from dataclasses import dataclass

import mujoco
import numpy as np

from hexarm.simulation.rigid_body import Mechanism
from manipulator.arrays import Array, frozen
from manipulator.errors import ManipulatorError
from manipulator.formatting import length
from manipulator.pose import Pose

CLOSED = 1e-5
"""Metres between the ends of a closed loop that count as closed."""


class DoesNotAssemble(ManipulatorError, ValueError):
    """A model whose loops do not close; `leg` counts from 1."""

    def __init__(self, message: str, leg: int) -> None:
        super().__init__(message)
        self.leg = leg


@dataclass(frozen=True, eq=False)
class Reading:
    """What ideal sensors show: joints (n,), their rates and efforts; the platform's motion.

    SI units and radians; twist and acceleration (6,) of the moving frame's origin in base axes.
    effort is what the drive's motor gives, back voltage included.
    """

    time: float
    joints: Array
    rates: Array
    effort: Array
    pose: Pose
    twist: Array
    acceleration: Array


class Simulation:
    """One machine in MuJoCo, at rest at a pose; raises DoesNotAssemble where that cannot be."""

    def __init__(self, mechanism: Mechanism, pose: Pose, joints: Array) -> None:
        self.mechanism = mechanism
        self.model = mujoco.MjModel.from_xml_string(mechanism.xml)
        self.state = mujoco.MjData(self.model)
        self._positions, self._rates = _shares(self.model, mechanism.joints)
        self._moving = self.model.body(mechanism.moving).id
        pairs = mechanism.closures.values()
        self._ends = np.array([[self.model.site(s).id for s in p] for p in pairs], dtype=int)
        self.reset(pose, joints)

    @property
    def step_time(self) -> float:
        """Seconds a step."""
        return float(self.model.opt.timestep)

    def reset(self, pose: Pose, joints: Array) -> None:
        """At rest at `pose` with these joints, which are the targets too."""
        mujoco.mj_resetData(self.model, self.state)
        self.state.qpos[:] = self.mechanism.seat(pose, joints)
        self.state.ctrl[:] = joints
        mujoco.mj_forward(self.model, self.state)
        self.check_closed()

    def aim(self, targets: Array) -> None:
        """Where the drives are to go from now on (n,)."""
        self.state.ctrl[:] = targets

    def allow(self, effort: Array) -> None:
        """The most that each drive gives from now on (n,): 0 is a drive without power."""
        self.model.actuator_forcerange[:, 0] = -effort
        self.model.actuator_forcerange[:, 1] = effort

    def step(self, count: int = 1) -> None:
        """`count` steps of step_time."""
        mujoco.mj_step(self.model, self.state, count)
        # MuJoCo leaves bodies where they were before the last step.
        mujoco.mj_kinematics(self.model, self.state)

    def closure_errors(self) -> Array:
        """How far the ends of each closed loop are apart, metres (legs,)."""
        if not len(self._ends):
            return np.zeros(0)
        gaps = np.diff(self.state.site_xpos[self._ends], axis=1)[:, 0]
        return np.asarray(np.linalg.norm(gaps, axis=1))

    def check_closed(self) -> None:
        """Raises DoesNotAssemble, naming the leg that misses the most."""
        errors = self.closure_errors()
        if len(errors) and not errors.max() <= CLOSED:
            worst = int(np.argmax(errors))
            owner = list(self.mechanism.closures)[worst]
            raise DoesNotAssemble(
                f'{owner} does not close: its end is {length(errors[worst], 3)} from its joint '
                f'on the platform, at most {length(CLOSED)}',
                worst + 1,
            )

    @property
    def joints(self) -> Array:
        """Where the joints are (n,)."""
        return frozen(self._positions @ self.state.qpos)

    @property
    def pose(self) -> Pose:
        """Where the platform or tool is."""
        body = self.state.body(self._moving)
        return Pose(body.xpos, body.xmat.reshape(3, 3))

    def watched(self) -> Reading:
        """All sensors after one more step; efforts and acceleration are those during it."""
        before = self._twist()
        self.step()
        twist = self._twist()
        rates = self._rates @ self.state.qvel
        return Reading(
            float(self.state.time),
            self.joints,
            frozen(rates),
            frozen(self.state.actuator_force - self.mechanism.drives.damping * rates),
            self.pose,
            frozen(twist),
            frozen((twist - before) / self.step_time),
        )

    def _twist(self) -> Array:
        """The moving frame's, in base axes."""
        mujoco.mj_comPos(self.model, self.state)
        mujoco.mj_comVel(self.model, self.state)
        kind, turning_first = mujoco.mjtObj.mjOBJ_XBODY, np.zeros(6)
        mujoco.mj_objectVelocity(self.model, self.state, kind, self._moving, turning_first, 0)
        return np.concatenate([turning_first[3:], turning_first[:3]])


def _shares(model: mujoco.MjModel, names: tuple[str, ...]) -> tuple[Array, Array]:
    """What actuators move, as shares of qpos (n, nq) and of qvel (n, nv): joints, or tendons."""
    positions, rates = np.zeros((len(names), model.nq)), np.zeros((len(names), model.nv))
    for i, name in enumerate(names):
        actuator = model.actuator(name).id
        parts = [(int(model.actuator_trnid[actuator, 0]), 1.0)]
        if model.actuator_trntype[actuator] == mujoco.mjtTrn.mjTRN_TENDON:
            first, count = (a[parts[0][0]] for a in (model.tendon_adr, model.tendon_num))
            wraps = range(first, first + count)
            parts = [(int(model.wrap_objid[k]), float(model.wrap_prm[k])) for k in wraps]
        for joint, share in parts:
            positions[i, model.jnt_qposadr[joint]] = share
            rates[i, model.jnt_dofadr[joint]] = share
    return positions, rates
