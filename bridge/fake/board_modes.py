"""The board's modes: when pulses go out, when they follow the host, when they stand still.

The firmware has the same state machine (docs/protocol.md draws it). Times in microseconds since
the start, as the board counts them.
"""

from bridge.fake.board_arming import Arming
from bridge.fake.board_programs import Programs, Step
from bridge.fake.board_setpoint import range_fault, setpoint_fault
from bridge.fake.board_settings import BoardSettings
from bridge.fake.board_supply import Supply
from bridge.fake.pulse_drive import PulseDrive
from bridge.protocol import (
    MAX_DEADLINE_MS,
    NO_JOINT,
    Arm,
    Clear,
    Command,
    CycleAxis,
    Disarm,
    Fault,
    FaultCode,
    Finish,
    Flag,
    Mode,
    Play,
    Program,
    ProgramPart,
    Result,
    Setpoint,
    Stop,
)

PULSE_PERIOD_US = 20_000

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
        self._deadline_us: int | None = None
        self._is_hosts = False
        self._is_cleared = False
        self._program_after_arming: Program | None = None
        self._arming = Arming(self.drive, settings.arm_interval_us)
        self._supply = Supply(settings.minimum_battery_mv)
        ranges, speeds = settings.count_ranges, settings.count_speeds
        self._programs = Programs(ranges, speeds, settings.solve, axes)

    @property
    def flags(self) -> Flag:
        """The flags of a STATE."""
        return Flag(
            Flag.DEADLINE_PASSED * self.is_deadline_passed
            | Flag.UNDERVOLTAGE * self._supply.is_low
            | Flag.SLEWING * self.drive.is_slewing
        )

    def pass_period(self, now_us: int, battery_mv: int) -> Fault | None:
        """One pulse period: deadlines, battery, arming, slewing; a fault when one begins."""
        fault = self._watch_battery(now_us, battery_mv)
        self._watch_deadline(now_us)
        if self.mode is Mode.ARMING:
            self._arm_on(now_us)
        if fault is None and self.mode in BY_ITSELF:
            fault = self._play_on(now_us)
        self.drive.advance(PULSE_PERIOD_US * 1e-6)
        return fault

    def follow(self, setpoint: Setpoint, now_us: int) -> Fault | None:
        """Aims at the setpoint; or says why not, and nothing has changed."""
        if self.mode not in FOLLOWING:
            return Fault(FaultCode.NOT_ARMED, NO_JOINT, self.mode)
        fault = setpoint_fault(setpoint, self.settings.count_ranges)
        if fault is None:
            self.drive.aim(setpoint.counts)
            self._wait_armed(now_us, setpoint.deadline_ms)
            self._is_hosts, self._is_cleared = True, False
        return fault

    def obey(self, command: Command, now_us: int) -> Result:
        """Does what a host asks, or says why not and changes nothing.

        What the start button wanted to play is forgotten then, and the machine is the host's until
        its deadline passes; only uploading a program claims nothing.
        """
        result = self._obey(command, now_us)
        if result is Result.OK:
            self._program_after_arming = None
            if not isinstance(command, ProgramPart):
                self._is_hosts = self.mode not in (Mode.DISARMED, Mode.HOLDING)
        return result

    def stop(self, now_us: int) -> Result:
        """Stands still until CLEAR; the stop button's way too."""
        self._hold(Mode.STOPPED, now_us)
        return Result.OK

    def press_start(self, now_us: int) -> None:
        """The start button: clears, ends a program or plays one; never against a host."""
        if self.mode in LATCHED:
            self._clear(now_us)
        elif self.mode in BY_ITSELF:
            self._programs.finish()
        elif self.mode in FOLLOWING and not self._is_hosts:
            self._play(Play(self._programs.to_start, True), now_us)
        elif self.mode is Mode.DISARMED:
            start = self._programs.start_counts(self._programs.to_start)
            if start is not None and self._arm(start, now_us) is Result.OK:
                self._program_after_arming = self._programs.to_start

    def _obey(self, command: Command, now_us: int) -> Result:
        match command:
            case Arm(park):
                return self._arm(park, now_us)
            case Disarm():
                return self._disarm(now_us)
            case Stop():
                return self.stop(now_us)
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
        if self._supply.is_low:
            return Result.UNDERVOLTAGE
        if len(park) != len(self.settings.count_ranges):
            return Result.WRONG_JOINTS
        if range_fault(park, self.settings.count_ranges) is not None:
            return Result.OUT_OF_RANGE
        if self.mode in (*FOLLOWING, *BY_ITSELF):
            self._hold(Mode.ARMED, now_us)
        elif self.mode is Mode.DISARMED:
            self._arming.begin(park, now_us)
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
        if self._supply.is_low:
            return Result.UNDERVOLTAGE
        self.fault = FaultCode.NONE
        if self.drive.is_all_on:
            self._hold(Mode.ARMED, now_us)
        else:
            self.drive.release()
            self._hold(Mode.DISARMED, now_us)
        self._is_cleared = True
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
        self.is_deadline_passed = self._is_cleared = False
        self._program_after_arming = None
        if mode in (Mode.DISARMED, Mode.HOLDING):
            self._is_hosts = False
        self.mode = mode
        if mode is Mode.ARMED:
            self._wait_armed(now_us)

    def _wait_armed(self, now_us: int, deadline_ms: int = MAX_DEADLINE_MS) -> None:
        """Armed until the next setpoint is overdue: the first one by the longest deadline."""
        self.mode = Mode.ARMED
        self._deadline_us = now_us + 1000 * deadline_ms
        self.is_deadline_passed = False

    def _watch_deadline(self, now_us: int) -> None:
        """A machine that stood still under a STOP does not fall because somebody cleared it."""
        if self._deadline_us is None or now_us < self._deadline_us:
            return
        if self.settings.on_link_loss == 'release' and not self._is_cleared:
            self.drive.release()
            self._hold(Mode.DISARMED, now_us)
        else:
            self._hold(Mode.HOLDING, now_us)
        self.is_deadline_passed = True

    def _watch_battery(self, now_us: int, battery_mv: int) -> Fault | None:
        """Refuses to arm at once, but only a lasting undervoltage stops what moves."""
        self._supply.watch(now_us, battery_mv)
        if not self._supply.is_exhausted or self.mode in (Mode.DISARMED, *LATCHED):
            return None
        self._hold(Mode.FAULT, now_us)
        self.fault = FaultCode.UNDERVOLTAGE
        return Fault(FaultCode.UNDERVOLTAGE, NO_JOINT, battery_mv)

    def _arm_on(self, now_us: int) -> None:
        if not self._arming.step(now_us):
            return
        program = self._program_after_arming
        self._hold(Mode.ARMED, now_us)
        if program is not None:
            self._play(Play(program, True), now_us)
