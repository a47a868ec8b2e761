"""A serial port that this process has to itself; every failure is one sentence."""

import contextlib
import errno
import os

import serial

from manipulator.errors import LinkError

_REASONS = {
    errno.ENOENT: 'does not exist: is the board plugged in?',
    errno.ENXIO: 'does not exist: is the board plugged in?',
    errno.ENODEV: 'does not exist: is the board plugged in?',
    errno.EIO: 'has no board behind it any more',
    errno.EACCES: 'is not permitted: add yourself to the group dialout '
    "('sudo usermod -aG dialout $USER', then log in again)",
    errno.EPERM: 'is not permitted: is another program using it exclusively?',
    errno.EBUSY: 'is in use by another program',
    errno.EAGAIN: 'is in use by another program (a second serial_bridge?)',
    errno.ENOTTY: 'is not a serial port',
    errno.EINVAL: 'is not a serial port, or cannot run at this baud rate',
    errno.EISDIR: 'is a folder, not a serial port',
    errno.ELOOP: 'is a link that leads to itself',
}
MAX_READ = 4096


class SerialPort:
    """An open port that never blocks. Opening it resets an Arduino: it boots for 1 to 2 s."""

    def __init__(self, name: str, baud: int) -> None:
        """LinkError says why the port cannot be opened."""
        self.name = name
        try:
            self._port = serial.Serial(name, baud, timeout=0, exclusive=True)
        except (serial.SerialException, OSError, ValueError) as error:
            raise LinkError(f'{name} {_reason(error)}') from error
        # Only some adapters know it (FTDI: 1 ms instead of 16); all others do without.
        with contextlib.suppress(OSError, ValueError, NotImplementedError, AttributeError):
            self._port.set_low_latency_mode(True)

    def fileno(self) -> int:
        """For select."""
        return int(self._port.fileno())

    def read(self) -> bytes:
        """What has arrived, once select says that something has; LinkError: it was the end."""
        try:
            received = os.read(self.fileno(), MAX_READ)
        except BlockingIOError:
            return b''
        except OSError as error:
            raise LinkError(f'{self.name} has vanished ({_reason(error)})') from error
        if not received:
            raise LinkError(f'{self.name} has vanished (unplugged?)')
        return received

    def write(self, waiting: bytes) -> bytes:
        """Writes what fits and returns the rest; LinkError when the port has vanished."""
        try:
            return waiting[os.write(self.fileno(), waiting) :]
        except BlockingIOError:
            return waiting
        except OSError as error:
            raise LinkError(f'{self.name} has vanished ({_reason(error)})') from error

    def close(self) -> None:
        """Gives the port back; what is still in its buffers is lost."""
        with contextlib.suppress(OSError):
            self._port.close()


def _reason(error: Exception) -> str:
    """What the error number means; pyserial drops the one of termios, which stands behind it."""
    behind = error.__context__
    number = getattr(error, 'errno', None) or (behind.args[0] if behind and behind.args else None)
    return _REASONS.get(number or 0) or f'cannot be used: {error}'
