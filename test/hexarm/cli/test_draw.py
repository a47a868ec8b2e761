"""`hexarm draw`: a machine at a pose, with what its measures are."""

import json
from itertools import combinations

import pytest

from hexarm.cli.main import main


@pytest.fixture
def figures(monkeypatch):
    """The figures that are saved, open."""
    plt, saved = pytest.importorskip('matplotlib.pyplot'), []
    with monkeypatch.context() as changed:
        changed.setattr(plt, 'close', saved.append)
        yield saved
    plt.close('all')


def words(figure):
    texts = [t.get_text() for t in figure.texts]
    return texts + [t.get_text() for axes in figure.axes for t in axes.texts]


@pytest.mark.parametrize(
    ('machine', 'measures'),
    [
        ('robocake', {'R 96.67', 'R 76.15', '41.19', '17.5', '58'}),
        ('stewart_6_6', {'R 100', 'R 50', '186.81', '190'}),
        ('linear_rails', {'R 37.5', '150.4', '297.85'}),
        ('ur5', {'425', '392.3', '431.86'}),
        ('stack_6_6', {'R 100', '568.42'}),
        ('niryo_one', {'17.3', '7.3'}),
    ],
)
def test_picture_names_the_machines_measures(machine, measures, figures, tmp_path, capsys):
    picture = tmp_path / 'drawn.png'
    assert main(['draw', machine, '-o', str(picture)]) == 0
    assert capsys.readouterr().out.strip() == str(picture)
    assert measures <= set(words(figures[0]))
    for axes in figures[0].axes[:3]:
        for dots in axes.lines:
            (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
            x, y = dots.get_data()
            assert (x0 <= x.min() and x.max() <= x1) or dots.get_linewidth() < 1
            assert (y0 <= y.min() and y.max() <= y1) or dots.get_linewidth() < 1
    boxes = [text.get_window_extent() for text in figures[0].axes[3].texts]
    assert not any(a.overlaps(b) for a, b in combinations(boxes, 2))
    assert [path.name for path in tmp_path.iterdir()] == ['drawn.png']


def test_pose_in_millimetres_beyond_a_limit_is_drawn_and_named(tmp_path, capsys):
    picture = tmp_path / 'drawn.svg'
    words = ['--xyz', '0', '0', '22', '--units', 'mm', '--json', '-o', str(picture)]
    assert main(['draw', 'robocake', *words]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer['picture'] == str(picture)
    assert 'height' in ' '.join(answer['beyond_limits'])
    assert picture.read_text().startswith('<?xml')


def test_pose_out_of_reach_draws_nothing(tmp_path, capsys):
    assert main(['draw', 'robocake', '--xyz', '0', '0', '0.2', '-o', str(tmp_path / 'x.png')]) == 3
    assert 'rod too short' in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
