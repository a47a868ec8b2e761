import pytest

from bridge.fake.faults import FaultKind
from bridge.fake.faulty_bytes import FaultyBytes

PIECES = [bytes([k, k + 1, k + 2, k + 3]) for k in range(0, 200, 4)]


def passed(faults, seed=1):
    """What comes out of fifty pieces, and how much is still on its way after each."""
    line = FaultyBytes(seed)
    out = [line.pass_on(piece, faults, 0.01 * k) for k, piece in enumerate(PIECES)]
    late = [line.pass_on(b'', faults, 0.5 + 0.01 * k) for k in range(100)]
    return out, b''.join(out + late)


def test_a_good_line_passes_everything_at_once():
    assert passed(set())[0] == PIECES


@pytest.mark.parametrize('kind', [FaultKind.DELAY, FaultKind.SPLIT])
def test_late_bytes_come_whole_and_in_order(kind):
    out, together = passed({kind})
    assert out != PIECES
    assert together == b''.join(PIECES)


def test_dropped_bytes_are_missing():
    _, together = passed({FaultKind.DROP})
    whole = iter(b''.join(PIECES))
    assert all(byte in whole for byte in together)
    assert 100 < len(together) < 200


def test_duplicated_bytes_come_twice():
    _, together = passed({FaultKind.DUPLICATE})
    assert set(together) == set(range(200))
    assert len(together) > 220


def test_corrupt_bytes_have_one_bit_changed():
    _, together = passed({FaultKind.CORRUPT})
    changed = [a ^ b for a, b in zip(together, b''.join(PIECES), strict=True) if a != b]
    assert 10 < len(changed) < 40
    assert all(bit & (bit - 1) == 0 for bit in changed)


def test_all_at_once_never_lets_bytes_pile_up():
    line = FaultyBytes(5)
    most = 0
    for k in range(20_000):
        line.pass_on(b'abcd', set(FaultKind), 0.01 * k)
        most = max(most, sum(len(piece) for _, piece in line._on_their_way))
    assert most < 4 * 40 * 2
