"""From measurements to the machine that they are of: the most probable values, given a prior.

Minimises |r(x)|² + |x|² where r are errors in multiples of their noise and x values in multiples
of their tolerances; where a tolerance is infinite, that value has no prior and x counts in SI.
"""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from manipulator import rotation as so3
from manipulator.analysis.device_frames import COUNT, GROUPS, DeviceFrames
from manipulator.analysis.measurements import Measurements, Model, Noise, Parameter
from manipulator.arrays import Array, Mask
from manipulator.errors import InvalidInput, NoSolution
from manipulator.formatting import shown
from manipulator.pose import Pose

Errors = Callable[[Array], tuple[Array, Array]]
"""Values (p,) to errors (m,) and their slopes (m, p)."""

MOST_EVALUATIONS = 200
STILL = 1e-10
BEYOND = 1e9
"""The error, by its noise, where the machine cannot stand: a shorter step is tried instead."""


@dataclass(frozen=True, eq=False)
class Fit:
    """Values (p,) and their covariance (p, p), errors and prior taken together."""

    values: Array
    covariance: Array


def fit(errors: Errors, tolerances: Array) -> Fit:
    """The values (p,), beginning at zero; NoSolution where no minimum is found."""
    from scipy.optimize import least_squares  # noqa: PLC0415 (50 MB: only needed here)

    has_prior = np.isfinite(tolerances)
    scale, prior = np.where(has_prior, tolerances, 1.0), np.diag(has_prior.astype(np.float64))
    beyond = np.full_like(errors(np.zeros(len(scale)))[0], BEYOND), np.zeros((0, len(scale)))

    @lru_cache(maxsize=1)  # MINPACK requests errors and slopes separately; they are found together
    def at(x: tuple[float, ...]) -> tuple[Array, Array]:
        values = np.array(x)
        try:
            r, J = errors(scale * values)
        except NoSolution:
            r, J = beyond
        return np.concatenate([r, prior @ values]), np.concatenate([J * scale, prior])

    found = least_squares(
        lambda x: at(tuple(x))[0], np.zeros(len(scale)), lambda x: at(tuple(x))[1], method='lm',
        x_scale='jac', ftol=STILL, xtol=STILL, gtol=STILL, max_nfev=MOST_EVALUATIONS,
    )  # fmt: skip
    if not found.success:
        raise NoSolution('the parameters do not converge: are the measurements of this machine?')
    inverse = scale[:, None] * np.linalg.pinv(found.jac)
    return Fit(scale * found.x, inverse @ inverse.T)


@dataclass(frozen=True, eq=False)
class Identification:
    """What was found.

    parameters, values (p,) and covariance (p, p) are of the model first, then the 12 of the
    frames; what was not free has value and covariance 0. frames are those
    found. before and after are the errors (n, 6) in m and rad, of the machine file with the best
    frames and of what was found. slopes (6n, p) are per multiple of the noise.
    """

    parameters: tuple[Parameter, ...]
    is_free: Mask
    values: Array
    covariance: Array
    frames: DeviceFrames
    before: Array
    after: Array
    slopes: Array

    @property
    def deviations(self) -> Array:
        """Standard deviations (p,), m or rad."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))

    @property
    def model_values(self) -> Array:
        """The values of the machine alone."""
        return self.values[:-COUNT]


@dataclass(frozen=True, eq=False)
class Sight:
    """A machine as the device sees it: model and frames as one function of all values."""

    model: Model
    frames: DeviceFrames
    measurements: Measurements
    noise: Noise
    near: Pose

    def errors(self, values: Array) -> Array:
        """(n, 6): measured less predicted, m and rad, in the device's axes."""
        return self._predicted(values)[1]

    def weighted(self, values: Array) -> tuple[Array, Array]:
        """Errors (6n,) and slopes (6n, p) in multiples of the noise."""
        platform, errors = self._predicted(values)
        own = self.model.slopes(values[:-COUNT], self.measurements.joints, platform)
        slopes = self.frames.slopes(values[-COUNT:], platform, own)
        weights = self.noise.weights
        rows = -slopes * weights[:, None]
        return (errors * weights).ravel(), rows.reshape(-1, rows.shape[2])

    def _predicted(self, values: Array) -> tuple[Pose, Array]:
        platform = self.model.predict(values[:-COUNT], self.measurements.joints, self.near)
        seen = self.frames.moved(values[-COUNT:]).seen(platform)
        measured = self.measurements.poses
        turn = so3.log(measured.rotation @ np.swapaxes(seen.rotation, -1, -2))
        return platform, np.concatenate([measured.position - seen.position, turn], axis=1)


def identify(
    model: Model, measurements: Measurements, noise: Noise, near: Pose, free: Collection[str]
) -> Identification:
    """The most probable machine, given the noise and the tolerances.

    near (n,) are the poses by the machine file; free the groups of parameters that are sought.
    Where the frames are not free, the device reports poses of the platform in the base frame.
    Raises InvalidInput for a group that there is not, NoSolution where nothing fits.
    """
    parameters = (*model.parameters, *DeviceFrames.parameters())
    is_free = free_mask(parameters, free)
    known = DeviceFrames.known()
    guessed = DeviceFrames.guessed(near, measurements.poses) if set(GROUPS) & set(free) else known
    frames = DeviceFrames(
        guessed.T_device_base if 'device' in free else known.T_device_base,
        guessed.T_platform_marker if 'marker' in free else known.T_platform_marker,
    )
    sight = Sight(model, frames, measurements, noise, near)
    best_frames = _fitted(sight, parameters, is_free & _is_frame(parameters))[0]
    values, found = _fitted(sight, parameters, is_free)
    covariance = np.zeros((len(parameters),) * 2)
    if found is not None:
        covariance[np.ix_(is_free, is_free)] = found.covariance
    return Identification(
        parameters,
        is_free,
        values,
        covariance,
        frames.moved(values[-COUNT:]),
        sight.errors(best_frames),
        sight.errors(values),
        sight.weighted(values)[1],
    )


def free_mask(parameters: tuple[Parameter, ...], free: Collection[str]) -> Mask:
    """Which parameters are in the groups; InvalidInput names a group that there is not."""
    groups = list(dict.fromkeys(parameter.group for parameter in parameters))
    for group in free:
        if group not in groups:
            raise InvalidInput(f'no parameters are called {shown(group)} (there are {groups})')
    return np.array([parameter.group in free for parameter in parameters])


def _is_frame(parameters: tuple[Parameter, ...]) -> Mask:
    is_frame: Mask = np.arange(len(parameters)) >= len(parameters) - COUNT
    return is_frame


def _fitted(
    sight: Sight, parameters: tuple[Parameter, ...], mask: Mask
) -> tuple[Array, Fit | None]:
    """All values, those of the mask fitted and the others zero."""
    values = np.zeros(len(parameters))
    if not mask.any():
        return values, None
    tolerances = np.array([parameter.tolerance for parameter in parameters])[mask]

    def errors(some: Array) -> tuple[Array, Array]:
        whole = values.copy()
        whole[mask] = some
        r, slopes = sight.weighted(whole)
        if not np.isfinite(slopes).all():
            raise NoSolution('a singular pose')
        return r, slopes[:, mask]

    found = fit(errors, tolerances)
    values[mask] = found.values
    return values, found
