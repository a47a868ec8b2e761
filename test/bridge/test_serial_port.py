import os

import pytest

from bridge.fake.fake_line import FakeLine
from bridge.link_thread import SerialPort
from manipulator.errors import LinkError


@pytest.fixture
def line(tmp_path):
    line = FakeLine(tmp_path / 'board')
    yield line
    line.close()


def test_bytes_go_both_ways(line):
    port = SerialPort(str(line.path), 250_000)
    line.write(b'\x01\x00\xff')
    assert port.read() == b'\x01\x00\xff'
    assert port.write(b'\x0d\x0a\x11') == b''
    assert line.read() == b'\x0d\x0a\x11'
    port.close()


def test_what_does_not_fit_is_handed_back(line):
    port = SerialPort(str(line.path), 250_000)
    whole = rest = b'x' * 1_000_000
    for _ in range(100):
        rest = port.write(rest)
    assert 0 < len(rest) < len(whole)
    port.close()


@pytest.mark.parametrize(
    ('name', 'reason'),
    [('missing', 'does not exist'), ('plain', 'is not a serial port'), ('', 'is a folder')],
)
def test_a_port_that_cannot_be_one_is_named(tmp_path, name, reason):
    (tmp_path / 'plain').write_text('no port')
    with pytest.raises(LinkError, match=reason) as caught:
        SerialPort(str(tmp_path / name), 250_000)
    assert str(caught.value).startswith(str(tmp_path / name))
    assert '\n' not in str(caught.value)


def test_a_forbidden_port_reports_dialout(line, monkeypatch):
    real_open = os.open

    def forbid(path, *arguments, **options):
        # Root may open everything, so the kernel's answer is given here.
        if str(path) == str(line.path):
            raise PermissionError(13, 'Permission denied', path)
        return real_open(path, *arguments, **options)

    monkeypatch.setattr(os, 'open', forbid)
    with pytest.raises(LinkError, match=r'is not permitted: .* dialout'):
        SerialPort(str(line.path), 250_000)


def test_a_second_host_is_informed_that_the_port_is_in_use(line):
    first = SerialPort(str(line.path), 250_000)
    with pytest.raises(LinkError, match='in use by another program'):
        SerialPort(str(line.path), 250_000)
    first.close()
    SerialPort(str(line.path), 250_000).close()


def test_a_second_reader_is_told_from_a_port_that_vanishes(line):
    port = SerialPort(str(line.path), 250_000)
    line.write(b'taken')
    assert os.read(port.fileno(), 100) == b'taken'  # as by a process that had the port before
    with pytest.raises(LinkError, match='is read by another program as well'):
        port.read()
    port.close()


def test_a_port_that_vanishes_is_noticed_on_read_and_write(tmp_path):
    line = FakeLine(tmp_path / 'board')
    port = SerialPort(str(line.path), 250_000)
    line.close()
    with pytest.raises(LinkError, match='was disconnected'):
        port.read()
    with pytest.raises(LinkError, match='was disconnected'):
        port.write(b'x')
    port.close()
