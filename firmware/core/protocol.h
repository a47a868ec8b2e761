/* The messages between host and board: docs/protocol.md holds the frame table. */
#pragma once

#define PROTOCOL_VERSION 1
/* As many as a STATE of 63 bytes holds. The chip, which has fewer channels, is built for those. */
#ifndef MAX_JOINTS
#define MAX_JOINTS 18
#endif
#define NO_JOINT 255
#define MIN_DEADLINE_MS 1
#define MAX_DEADLINE_MS 2000

enum Type {
    TYPE_SETPOINT = 0x01,
    TYPE_ARM = 0x02,
    TYPE_DISARM = 0x03,
    TYPE_STOP = 0x04,
    TYPE_CLEAR = 0x05,
    TYPE_CYCLE_AXIS = 0x06,
    TYPE_TABLE_BEGIN = 0x07,
    TYPE_TABLE_ROW = 0x08,
    TYPE_TABLE_END = 0x09,
    TYPE_PLAY = 0x0A,
    TYPE_FINISH = 0x0B,
    TYPE_HELLO = 0x81,
    TYPE_STATE = 0x82,
    TYPE_ACK = 0x83,
    TYPE_FAULT = 0x84,
};

enum Mode {
    MODE_DISARMED = 0, /* no pulses */
    MODE_ARMING = 1,   /* servo after servo is energised at the park pose */
    MODE_ARMED = 2,    /* follows setpoints, waits for the first one */
    MODE_HOLDING = 3,  /* the deadline for the next setpoint passed */
    MODE_STOPPED = 4,  /* holds until CLEAR */
    MODE_FAULT = 5,    /* holds until CLEAR */
    MODE_CHECKING = 6, /* computes whether a program can be played; nothing moves */
    MODE_PLAYING = 7,  /* moves by itself, host or no host */
};

enum Program { PROGRAM_CYCLE = 1, PROGRAM_TABLE = 2, PROGRAM_FLASH_TABLE = 3 };

enum Known { KNOWN_UNKNOWN = 0, KNOWN_COMMANDED = 1, KNOWN_MEASURED = 2 };

enum Flag { FLAG_DEADLINE_PASSED = 1, FLAG_UNDERVOLTAGE = 2, FLAG_SLEWING = 4 };

enum Result {
    RESULT_OK = 0,
    RESULT_STALE = 1,
    RESULT_STOPPED = 2,
    RESULT_FAULT = 3,
    RESULT_UNDERVOLTAGE = 4,
    RESULT_OUT_OF_RANGE = 5,
    RESULT_WRONG_JOINTS = 6,
    RESULT_TOO_LARGE = 7,
    RESULT_BAD_TABLE = 8,
    RESULT_TOO_FAST = 9,
    RESULT_NOT_ARMED = 10,
    RESULT_NOT_AT_START = 11,
    RESULT_NO_PROGRAM = 12,
};

enum FaultCode {
    FAULT_NONE = 0,
    FAULT_OUT_OF_RANGE = 1,
    FAULT_WRONG_JOINTS = 2,
    FAULT_STALE = 3,
    FAULT_NOT_ARMED = 4,
    FAULT_BAD_DEADLINE = 5,
    FAULT_UNKNOWN_TYPE = 6,
    FAULT_MALFORMED = 7,
    FAULT_UNDERVOLTAGE = 8,
    FAULT_OUT_OF_REACH = 9,
    FAULT_TOO_FAST = 10,
};
