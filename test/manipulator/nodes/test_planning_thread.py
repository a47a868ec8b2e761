"""The worker beside the control loop: bounded by count, given up on request."""

from threading import Event

import pytest

from manipulator.errors import Refused
from manipulator.nodes.planning_thread import MOST_WAITING, PlanningThread
from manipulator.planning.worker import MOST_POSES, Cancelled, Effort, InPlace, TooLong

LONG = 30.0


@pytest.fixture
def worker():
    made = PlanningThread()
    yield made
    made.close()


def outcome(job):
    """What became of a job, however busy the computer is."""
    return job._future.result(LONG)


def test_effort_is_bounded_by_count():
    effort = Effort()
    effort.spend(MOST_POSES)
    with pytest.raises(TooLong, match=f'more than {MOST_POSES} poses'):
        effort.spend(1)


def test_a_task_runs_beside_its_caller_and_its_result_is_kept(worker):
    begun, go_on = Event(), Event()

    def task(effort):
        begun.set()
        assert go_on.wait(LONG)
        return 7

    job = worker.submit(task)
    assert begun.wait(LONG)
    assert not job.is_done
    go_on.set()
    assert outcome(job) == 7
    assert job.is_done
    assert job.result() == 7


def test_what_a_task_raises_comes_with_the_result(worker):
    def task(effort):
        raise Refused('no')

    job = worker.submit(task)
    with pytest.raises(Refused, match='no'):
        outcome(job)
    with pytest.raises(Refused, match='no'):
        job.result()


def test_a_cancelled_task_ends_at_its_next_pose(worker):
    begun, cancelled = Event(), Event()

    def task(effort):
        begun.set()
        assert cancelled.wait(LONG)
        effort.spend(1)

    job = worker.submit(task)
    assert begun.wait(LONG)
    job.cancel()
    cancelled.set()
    with pytest.raises(Cancelled):
        outcome(job)


def test_closing_gives_up_the_task_that_runs(worker):
    begun, closed = Event(), Event()

    def task(effort):
        begun.set()
        assert closed.wait(LONG)
        effort.spend(1)

    job = worker.submit(task)
    assert begun.wait(LONG)
    worker.close()
    closed.set()
    with pytest.raises(Cancelled):
        outcome(job)


def test_more_tasks_than_may_wait_are_refused_and_later_ones_are_taken(worker):
    go_on = Event()
    jobs = [worker.submit(lambda effort: go_on.wait(LONG)) for _ in range(MOST_WAITING + 1)]
    with pytest.raises(Refused, match=f'{MOST_WAITING} plans wait already'):
        worker.submit(lambda effort: None)
    go_on.set()
    for job in jobs:
        outcome(job)
    assert outcome(worker.submit(lambda effort: 3)) == 3


def test_in_place_a_job_is_done_when_it_comes_back():
    job = InPlace().submit(lambda effort: 5)
    assert job.is_done
    assert job.result() == 5
