"""Geometry identification on simulated machines with known errors, at poses never measured."""

import numpy as np

from bench.row import Row
from hexarm.calibration.campaign import GOAL, UNSEEN, Campaign

MACHINES = 12


def rows() -> list[Row]:
    found = []
    for name in ('robocake', 'stewart_6_6', 'arm_6r', 'ur5'):
        campaign = Campaign.of(name)
        for is_known in (False, True):
            where = 'frames known' if is_known else 'unknown frames'
            runs = [campaign.run(seed, is_known) for seed in range(MACHINES)]
            after = np.array([run.after for run in runs])
            rms = np.sqrt((after**2).mean(axis=0))
            within = int((after.max(axis=1) <= GOAL).sum())
            title = f'calibration of {name}, {where}'
            before = 1e3 * np.sqrt(np.mean([run.before**2 for run in runs]))
            text = ', '.join(f'{axis} {1e3 * e:.3f}' for axis, e in zip('xyz', rms, strict=True))
            found.append(
                Row(f'{title}: rms at {UNSEEN} unseen poses, {MACHINES} machines',
                    f'{before:.2f} mm → {text} mm', '0.05 mm', bool(rms.max() <= GOAL))
            )  # fmt: skip
            found.append(
                Row(f'{title}: worst axis of a machine, machines within',
                    f'{1e3 * after.max():.3f} mm, {within} of {MACHINES}')
            )  # fmt: skip
            law = 1e3 * np.sqrt(np.mean([run.law**2 for run in runs], axis=0))
            text = ', '.join(f'{axis} {e:.3f}' for axis, e in zip('xyz', law, strict=True))
            found.append(Row(f'{title}: predicted by the covariance', f'{text} mm'))
    return found
