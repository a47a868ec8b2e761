"""One style for all pictures: what lies on one another shows, also in grey; files are whole."""

import numpy as np
import pytest

pytest.importorskip('matplotlib')
from matplotlib.colors import to_rgb

from hexarm.pictures import style, workspace
from hexarm.pictures.leg_motion import defined
from manipulator.errors import InvalidInput


def grey(colour):
    return float(np.dot(to_rgb(colour), (0.299, 0.587, 0.114)))


def test_curves_differ_in_grey_and_in_dashes():
    axes = [grey(colour) for colour in style.AXES]
    assert min(np.diff(axes)) > 0.15
    looks = [style.curve(k) for k in range(6)]
    assert len({str(look['ls']) for look in looks}) == len(looks)


def test_of_curves_on_one_another_each_shows():
    """What is drawn above leaves gaps: more than what is below it."""
    looks = sorted((style.curve(k) for k in range(6)), key=lambda look: look['zorder'])
    shares = [style.ink(look['ls']) for look in looks]
    assert shares == sorted(shares, reverse=True)
    assert shares[1] < 1.0


def test_a_limit_is_a_line_in_view_or_said_to_be_outside():
    figure, (near, far) = style.plt.subplots(1, 2)
    for axes in (near, far):
        axes.plot([0.0, 1.0], [-100.0, 100.0])
    style.limits(near, 300.0, '°/s')
    style.limits(far, 3000.0, '°/s')
    low, high = near.get_ylim()
    assert low < -300.0 < 300.0 < high
    assert (len(near.lines), len(far.lines)) == (3, 1)
    assert near.get_title(loc='right') == 'limit ±300 °/s'
    assert 'outside' in far.get_title(loc='right')
    style.plt.close(figure)


def test_space_has_one_scale():
    figure = style.plt.figure()
    axes = figure.add_subplot(projection='3d')
    axes.plot([0.0, 1.0], [0.0, 2.0], [0.0, 4.0])
    style.space(axes)
    sizes = np.ptp([axes.get_xlim3d(), axes.get_ylim3d(), axes.get_zlim3d()], axis=1)
    np.testing.assert_allclose(axes._box_aspect / sizes, (axes._box_aspect / sizes)[0])
    style.plt.close(figure)


@pytest.mark.parametrize('failure', [KeyboardInterrupt, OSError(28, 'No space left on device')])
def test_a_picture_that_fails_leaves_nothing(failure, tmp_path, monkeypatch):
    figure = style.plt.figure()

    def fail(part):
        part.write_bytes(b'half')
        raise failure

    monkeypatch.setattr(figure, 'savefig', fail)
    with pytest.raises((KeyboardInterrupt, InvalidInput)):
        style.save(figure, tmp_path / 'a.png')
    assert not list(tmp_path.iterdir())


def test_euler_angles_without_a_meaning_are_not_drawn():
    shown = defined(np.array([[0.4, 0.0, -0.4], [0.4, 0.1, -0.3]]))
    assert np.isnan(shown[0]).tolist() == [True, False, True]
    assert not np.isnan(shown[1]).any()


def test_animation_runs_at_an_even_speed_and_repeats_without_a_pause():
    pytest.importorskip('mujoco')
    from hexarm.pictures.animation import FRAME_MS, MOST_FRAMES, frames_of  # noqa: PLC0415

    times = np.arange(0.0, 2.0001, 0.002)
    steps = np.diff(np.append(times[frames_of(times)], times[-1]))
    np.testing.assert_allclose(steps, 1e-3 * FRAME_MS, atol=2e-3)
    assert len(frames_of(np.arange(0.0, 60.0, 0.002))) == MOST_FRAMES


def test_no_curve_joins_two_branches():
    joints = np.array([[0.0, 0.1], [0.1, 0.2], [2.0, 0.3], [2.1, 0.4]])
    gaps = np.isnan(workspace._with_gaps(joints)).all(axis=1)
    assert gaps.tolist() == [False, True, True, False]


def test_a_value_that_is_the_same_everywhere_has_a_scale_of_its_size():
    even = 1.0 + 1e-14 * np.arange(10)
    assert workspace._colour_limits(even) == pytest.approx((0.0, 2.0))
    assert workspace._colour_limits(np.array([1.0, 2.0]))[0] == 1.0
