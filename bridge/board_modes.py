"""The board's modes: when pulses go out, when they follow the host, when they stand still.

The firmware has the same state machine (docs/protocol.md draws it). Times in microseconds since
the start, as the board counts them.
"""

from bridge.board_programs import Programs, Step
from bridge.board_settings import BoardSettings
from bridge.messages import (
    MAX_DEADLINE_MS,
    MIN_DEADLINE_MS,
    NO_JOINT,
    Arm,
    Clear,
    Command,
    Disarm,
    Fault,
    FaultCode,
    Flag,
    Mode,
    Result,
    Setpoint,
    Stop,
)
from bridge.program_messages import CycleAxis, Finish, Play
from bridge.pulse_drive import PulseDrive

PULSE_PERIOD_US = 20_000
UNDERVOLTAGE_DELAY_US = 500_000

LATCHED = {Mode.STOPPED: Result.STOPPED, Mode.FAULT: Result.FAULT}
FOLLOWING = (Mode.ARMED, Mode.HOLDING)
BY_ITSELF = (Mode.CHECKING, Mode.PLAYING)
TROUBLES = {Step.UNREACHABLE: FaultCode.OUT_OF_REACH, Step.TOO_FAST: FaultCode.TOO_FAST}


class BoardModes:
    """Mode, pulses and deadlines of one board; starts disarmed, with no pulse on any channel."""

    def __init__(self, settings: BoardSettings, axes: list[CycleAxis]) -> None:
        """The cycle's axes outlive a reset: the board keeps them in its EEPROM."""
        self.settings = settings
        self.drive = PulseDrive(settings.count_speeds)
        self.mode = Mode.DISARMED
        self.fault = FaultCode.NONE
        self.is_deadline_passed = False
        self.is_undervoltage = False
        self._deadline_us: int | None = None
        self._low_since_us: int | None = None
        self._park: tuple[int, ...] = ()
        self._energise_at_us = 0
        ranges, speeds = settings.count_ranges, settings.count_speeds
        self._programs = Programs(ranges, speeds, settings.solve, axes)

    @property
    def flags(self) -> Flag:
        """The flags of a STATE."""
        return Flag(
            Flag.DEADLINE_PASSED * self.is_deadline_passed
            | Flag.UNDERVOLTAGE * self.is_undervoltage
            | Flag.SLEWING * self.drive.is_slewing
        )

    def pass_period(self, now_us: int, battery_mv: int) -> Fault | None:
        """One pulse period: deadlines, battery, arming, slewing; a fault when one begins."""
        fault = self._watch_battery(now_us, battery_mv)
        self._watch_deadline(now_us)
        self._energise_next(now_us)
        if fault is None and self.mode in BY_ITSELF:
            fault = self._play_on(now_us)
        self.drive.advance(PULSE_PERIOD_US * 1e-6)
        return fault

    def follow(self, setpoint: Setpoint, now_us: int) -> Fault | None:
        """Aims at the setpoint; or says why not, and nothing has changed."""
        fault = self._fault_in(setpoint)
        if fault is None:
            self.drive.aim(setpoint.counts)
            self._wait_armed(now_us, setpoint.deadline_ms)
        return fault

    def obey(self, command: Command, now_us: int) -> Result:
        """Does what is asked, or says why not and changes nothing."""
        match command:
            case Arm(park):
                return self._arm(park, now_us)
            case Disarm():
                return self._disarm(now_us)
            case Stop():
                self._hold(Mode.STOPPED, now_us)
                return Result.OK
            case Clear():
                return self._clear(now_us)
            case Play():
                return self._play(command, now_us)
            case Finish():
                self._programs.finish()
                return Result.OK
            case _:
                if self.mode in BY_ITSELF:
                    return Result.NO_PROGRAM
                return self._programs.store(command)

    def _arm(self, park: tuple[int, ...], now_us: int) -> Result:
        if self.mode in LATCHED:
            return LATCHED[self.mode]
        if self.is_undervoltage:
            return Result.UNDERVOLTAGE
        if len(park) != len(self.settings.count_ranges):
            return Result.WRONG_JOINTS
        if self._range_fault(park) is not None:
            return Result.OUT_OF_RANGE
        if self.mode in (*FOLLOWING, *BY_ITSELF):
            self._hold(Mode.ARMED, now_us)
        elif self.mode is Mode.DISARMED:
            self._park = park
            self._energise_at_us = now_us
            self._hold(Mode.ARMING, now_us)
        return Result.OK

    def _disarm(self, now_us: int) -> Result:
        self.drive.release()
        if self.mode not in LATCHED:
            self._hold(Mode.DISARMED, now_us)
        return Result.OK

    def _clear(self, now_us: int) -> Result:
        if self.mode not in LATCHED:
            return Result.OK
        if self.is_undervoltage:
            return Result.UNDERVOLTAGE
        self.fault = FaultCode.NONE
        if self.drive.is_all_on:
            self._hold(Mode.ARMED, now_us)
        else:
            self.drive.release()
            self._hold(Mode.DISARMED, now_us)
        return Result.OK

    def _play(self, play: Play, now_us: int) -> Result:
        if self.mode in LATCHED:
            return LATCHED[self.mode]
        if self.mode not in FOLLOWING:
            return Result.NOT_ARMED
        result = self._programs.begin(play.program, play.is_loop, self.drive.counts)
        if result is Result.OK:
            self._hold(Mode.CHECKING, now_us)
        return result

    def _play_on(self, now_us: int) -> Fault | None:
        """One period of a program; what cannot be reached ends it where the joints are."""
        step, counts = self._programs.step()
        if step in TROUBLES:
            self._hold(Mode.ARMED, now_us)
            return Fault(TROUBLES[step], NO_JOINT, self._programs.trouble_ms)
        if step is not Step.CHECKING:
            self.mode = Mode.PLAYING
            self.drive.aim([round(count) for count in counts])
        if step is Step.DONE:
            self._wait_armed(now_us)
        return None

    def _hold(self, mode: Mode, now_us: int) -> None:
        """Stands still in `mode`; only an armed board has a deadline."""
        self.drive.halt()
        self._deadline_us = None
        self.is_deadline_passed = False
        self.mode = mode
        if mode is Mode.ARMED:
            self._wait_armed(now_us)

    def _wait_armed(self, now_us: int, deadline_ms: int = MAX_DEADLINE_MS) -> None:
        """Armed until the next setpoint is overdue: the first one by the longest deadline."""
        self.mode = Mode.ARMED
        self._deadline_us = now_us + 1000 * deadline_ms
        self.is_deadline_passed = False

    def _fault_in(self, setpoint: Setpoint) -> Fault | None:
        if self.mode not in FOLLOWING:
            return Fault(FaultCode.NOT_ARMED, NO_JOINT, self.mode)
        if len(setpoint.counts) != len(self.settings.count_ranges):
            return Fault(FaultCode.WRONG_JOINTS, NO_JOINT, len(setpoint.counts))
        if not MIN_DEADLINE_MS <= setpoint.deadline_ms <= MAX_DEADLINE_MS:
            return Fault(FaultCode.BAD_DEADLINE, NO_JOINT, setpoint.deadline_ms)
        return self._range_fault(setpoint.counts)

    def _range_fault(self, counts: tuple[int, ...]) -> Fault | None:
        ranges = self.settings.count_ranges
        for i, (count, (low, high)) in enumerate(zip(counts, ranges, strict=True)):
            if not low <= count <= high:
                return Fault(FaultCode.OUT_OF_RANGE, i, count)
        return None

    def _watch_deadline(self, now_us: int) -> None:
        if self._deadline_us is None or now_us < self._deadline_us:
            return
        if self.settings.on_link_loss == 'release':
            self.drive.release()
            self._hold(Mode.DISARMED, now_us)
        else:
            self._hold(Mode.HOLDING, now_us)
        self.is_deadline_passed = True

    def _watch_battery(self, now_us: int, battery_mv: int) -> Fault | None:
        """Refuses to arm at once, but only a lasting undervoltage stops what moves."""
        self.is_undervoltage = battery_mv < self.settings.minimum_battery_mv
        if not self.is_undervoltage:
            self._low_since_us = None
            return None
        if self._low_since_us is None:
            self._low_since_us = now_us
        is_lasting = now_us - self._low_since_us >= UNDERVOLTAGE_DELAY_US
        if not is_lasting or self.mode in (Mode.DISARMED, *LATCHED):
            return None
        self._hold(Mode.FAULT, now_us)
        self.fault = FaultCode.UNDERVOLTAGE
        return Fault(FaultCode.UNDERVOLTAGE, NO_JOINT, battery_mv)

    def _energise_next(self, now_us: int) -> None:
        if self.mode is not Mode.ARMING or now_us < self._energise_at_us:
            return
        if self.drive.is_all_on:
            self._hold(Mode.ARMED, now_us)
            return
        channel = self.drive.pulses.index(None)
        self.drive.energise(channel, self._park[channel])
        self._energise_at_us = now_us + self.settings.arm_interval_us
