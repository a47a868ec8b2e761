import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from bridge import cobs
from manipulator.errors import ProtocolError

# From the examples of Cheshire and Baker's encoding that everybody quotes.
KNOWN = [
    ('', '01'),
    ('00', '0101'),
    ('0000', '010101'),
    ('001100', '01021101'),
    ('11220033', '0311220233'),
    ('11223344', '0511223344'),
    ('11000000', '02110101 01'),
]


@pytest.mark.parametrize(('content', 'stuffed'), KNOWN)
def test_known_encodings(content, stuffed):
    assert cobs.encode(bytes.fromhex(content)) == bytes.fromhex(stuffed)
    assert cobs.decode(bytes.fromhex(stuffed)) == bytes.fromhex(content)


@given(st.lists(st.binary(max_size=3) | st.integers(0, 600).map(lambda n: b'\x05' * n)))
@example([b'\x05' * 253, b'\0', b'\x07'])
@example([b'\x05' * 254, b'\0', b'\x07'])
@example([b'\x05' * 254])
def test_any_bytes_come_back_and_hold_no_zero(pieces):
    content = b''.join(pieces)
    stuffed = cobs.encode(content)
    assert 0 not in stuffed
    assert len(stuffed) <= len(content) + 1 + len(content) // 254
    assert cobs.decode(stuffed) == content


@pytest.mark.parametrize('damaged', ['05112233', '0311', '021100', 'ff01'])
def test_a_code_beyond_the_end_is_refused(damaged):
    with pytest.raises(ProtocolError, match='COBS code'):
        cobs.decode(bytes.fromhex(damaged))
