import numpy as np

from manipulator.planning.goal import Goal
from manipulator.planning.stream import Stream
from manipulator.pose import Pose

PERIOD, SPEED = 1 / 60, 0.1


def test_a_stream_that_comes_by_fits_and_starts_never_seems_to_run_backwards():
    rng = np.random.default_rng(5)
    for _ in range(60):
        stream, flows, came = Stream(0.0, np.subtract), [], 0.0
        for k in range(120):
            came = max(came + 1e-4, (k + rng.uniform(0.0, 1.4)) * PERIOD)
            place = np.array([SPEED * k * PERIOD])
            goal = stream.continued(Goal(Pose.identity(), received=came), place, came)
            flows += [] if goal.flow is None else [goal.flow]
            times = [time for time, _ in stream._even.points]
            assert all(np.diff(times) > 0.0), times
        assert len(flows) > 20
        assert all(np.isfinite(flow.twist).all() for flow in flows)
