import pytest

from manipulator.formatting import counted, decimals, length, not_one_of, plain, reason, told_apart


@pytest.mark.parametrize(
    ('metres', 'said'),
    [
        (0.0, '0 mm'),
        (2.2813e-5, '0.02281 mm'),
        (0.0228, '22.8 mm'),
        (-0.9999, '-999.9 mm'),
        (0.99999, '1 m'),
        (45.2, '45.2 m'),
        (45264.3, '45264 m'),
        (float('inf'), 'inf m'),
    ],
)
def test_lengths_are_reported_in_the_unit_that_fits(metres, said):
    assert length(metres, 5 if metres > 1e4 else 4) == said


def test_no_length_is_written_with_a_power_of_ten():
    assert plain(60000.0, 2) == '60000'
    assert plain(-1.7e-18) == '0'
    assert length(45264.3, 3) == '45300 m'
    assert length(1.234e-9, 3) == '0.00000123 mm'


def test_one_is_singular_and_all_else_plural():
    assert counted(1, 'pose') == '1 pose'
    assert counted(0, 'pose') == '0 poses'
    assert counted(2000, 'pose') == '2,000 poses'
    assert counted(2, 'axis', 'axes') == '2 axes'


def test_files_that_cannot_be_read_are_reported_without_error_numbers(tmp_path):
    with pytest.raises(OSError, match='No such') as missing:
        (tmp_path / 'none').read_text()
    assert reason(missing.value) == 'No such file or directory'
    (tmp_path / 'picture').write_bytes(b'a\xff')
    with pytest.raises(UnicodeDecodeError) as binary:
        (tmp_path / 'picture').read_text(encoding='utf-8')
    assert reason(binary.value) == 'it is no text in UTF-8 (byte 1)'
    assert reason(ValueError('not a number')) == 'not a number'


def test_values_that_differ_look_different():
    assert told_apart([500.0001, 500.0, 3.0]) == ['500.0001', '500', '3']
    assert told_apart([0.1 + 0.2, 0.3]) == ['0.3', '0.3']
    assert told_apart([142.01, 142.0], fewest=2) == ['142.01', '142']


def test_small_numbers_get_the_decimals_that_show_them():
    assert [decimals(largest) for largest in (250.0, 0.2, 0.0053, 0.0, float('nan'))] == [
        4,
        4,
        6,
        4,
        4,
    ]


def test_a_word_that_is_none_of_a_few_is_told_them_and_the_nearest():
    known = {'free': 0, 'parallel': 1}
    assert not_one_of('paralel', known) == (
        "'paralel' is not one of free, parallel, did you mean 'parallel'?"
    )
    assert not_one_of(7, known) == '7 is not one of free, parallel'
