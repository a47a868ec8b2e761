/* What the program knows of its machine. avr/target.h has it compiled in, from the header that
 * `hexarm firmware-header` makes; on a computer it is handed in (host/host.h).
 *
 * Counts are half microseconds of pulse, by channel. Metres and radians, base frame.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "crank.h"
#include "protocol.h"

typedef struct {
    uint8_t channel;
    float centre;       /* rad */
    float centre_count; /* pulse there */
    float scale;        /* counts a radian, signed */
} CrankServo;

typedef struct {
    bool is_known; /* false: another kind of machine, and the rest means nothing */
    float home_position[3], home_rotation[9];
    float minimum_height;
    float crank_lowest[LEGS]; /* rad */
    float crank_highest[LEGS];
    struct crank_legs legs;
    CrankServo servos[LEGS];
} CrankHexapod;

typedef struct {
    uint8_t protocol_version; /* what HELLO announces */
    uint8_t joint_count;      /* 1 to MAX_JOINTS: channels 0 to joint_count - 1 */
    bool releases_on_link_loss;
    uint16_t arm_interval_ms;
    uint16_t minimum_battery_mv; /* 0: no battery is watched */
    uint32_t baud;
    uint16_t lowest_counts[MAX_JOINTS];
    uint16_t highest_counts[MAX_JOINTS];
    float step_counts[MAX_JOINTS]; /* what a servo moves in a period at its rated speed */
    CrankHexapod hexapod;
} Machine;
