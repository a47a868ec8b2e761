import sys

import pytest

from bench import __main__, section
from bench.row import Row


@pytest.fixture
def room(tmp_path, monkeypatch):
    """A bench of modules that a test writes, as the package `bench` of this one test."""
    (tmp_path / 'peers').mkdir()
    monkeypatch.setattr(section, 'ROOM', tmp_path)
    monkeypatch.setattr('bench.__path__', [str(tmp_path)])
    yield tmp_path
    for name in [name for name in sys.modules if name.startswith('bench.made_up')]:
        del sys.modules[name]


def write(room, name, text):
    (room / f'{name}.py').write_text(f'"""What {name} measures."""\n\n{text}\n')


GOOD = "from bench.row import Row\n\n\ndef rows():\n    return [Row('speed', '1 m/s')]"


def test_modules_that_measure_something_are_listed_others_libraries_last(room):
    write(room, 'made_up_z', GOOD)
    write(room, 'made_up_parts', 'PARTS = 3')
    write(room, 'peers/made_up_a', GOOD)
    assert section.names() == ['made_up_z', 'peers.made_up_a']


def test_every_shipped_module_has_a_title_and_rows():
    assert {'kinematics', 'graph', 'peers.pinocchio_arm', 'peers.reachy_mini'} <= {
        *section.names()
    }


def test_a_section_holds_the_rows_under_the_modules_first_line(room):
    write(room, 'made_up_good', GOOD)
    found = section.measured('made_up_good')
    assert found.title == 'What made_up_good measures'
    assert found.rows == (Row('speed', '1 m/s'),)


def test_a_missing_library_is_reported_with_its_remedy_and_misses_no_goal(room):
    write(room, 'made_up_peer', f'import no_such_library\n{GOOD}')
    (row,) = section.measured('made_up_peer').rows
    assert row.name == 'no_such_library is not installed'
    assert row.value == "pip install 'hexarm[bench]'"
    assert row.reached


def test_a_module_that_fails_is_missed_and_ends_nothing(room):
    write(room, 'made_up_bad', "def rows():\n    raise ValueError('leg 3 fell off')")
    (row,) = section.measured('made_up_bad').rows
    assert row.value == 'ValueError: leg 3 fell off'
    assert not row.reached


def test_a_run_prints_the_table_writes_the_page_and_reports_missed_goals(room, capsys):
    write(room, 'made_up_good', GOOD)
    write(room, 'made_up_bad', "def rows():\n    raise ValueError('leg 3 fell off')")
    page = room / 'page.md'
    assert __main__.main(['made_up_good', '--write', str(page)]) == 0
    assert __main__.main([]) == 1
    assert 'leg 3 fell off' in capsys.readouterr().out
    assert '| speed | 1 m/s |' in page.read_text()


def test_a_name_that_measures_nothing_is_refused_with_those_that_do(capsys):
    with pytest.raises(SystemExit, match='2'):
        __main__.main(['kinematic'])
    assert 'nothing measures kinematic; there are arm, ' in capsys.readouterr().err
