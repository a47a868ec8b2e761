from bench.computer import this_computer
from bench.page import page, table
from bench.row import Row
from bench.section import Section

SECTIONS = (
    Section('kinematics', 'The crank hexapod', (Row('inverse', '30 µs', '4×', reached=False),), 2),
    Section('peers.mink_arm', 'mink', (Row('|v|', '1 | 2\nm/s'), Row('share', '1 %', '0 %')), 3),
)


def test_the_table_names_machine_sections_goals_and_what_was_missed():
    text = table({'date': '2030-01-02'}, SECTIONS)
    assert text.startswith('date: 2030-01-02\n')
    assert 'The crank hexapod  (kinematics, 2 s)' in text
    assert '  inverse  30 µs' in text
    assert 'goal 4×   MISSED' in text or 'goal 4×  MISSED' in text
    assert text.endswith('3 figures in 5 s; of 2 goals 1 missed: inverse.')


def test_the_page_has_a_heading_a_section_and_no_broken_cell():
    lines = page({'date': '2030-01-02'}, SECTIONS).splitlines()
    assert '| date | 2030-01-02 |' in lines
    assert '## The crank hexapod' in lines
    assert '| inverse | 30 µs | 4× | MISSED |' in lines
    assert r'| \|v\| | 1 \| 2 m/s |  |  |' in lines


def test_a_table_without_rows_is_a_table_still():
    assert '0 figures' in table({}, (Section('empty', 'Nothing', (), 0),))


def test_the_computer_is_reported_with_processor_load_and_versions():
    reported = this_computer()
    assert {'date', 'commit', 'processor', 'Python, numpy'} <= set(reported)
    assert all(reported.values())
