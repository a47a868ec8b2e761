/* What the program knows of its machine. avr/target.h has it compiled in, from the header that
 * `hexarm firmware-header` makes; on a computer it is handed in (host/host.h).
 *
 * Counts are half microseconds of pulse, by channel. Metres and radians, base frame.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "protocol.h"

enum { LEGS = 6 };

typedef struct {
    float centre[3];   /* of the crank */
    float normal[3];   /* tangent x up */
    float tangent[3];  /* where the crank's angle is 0 */
    float up[3];       /* where it is a right angle */
    float platform[3]; /* where the rod ends, platform frame */
    float crank;       /* lengths */
    float rod;
} CrankLeg;

typedef struct {
    uint8_t channel;
    float centre;       /* rad */
    float centre_count; /* pulse there */
    float scale;        /* counts a radian, signed */
} CrankServo;

typedef struct {
    bool is_known; /* false: another kind of machine, and the rest means nothing */
    float home_height;
    float minimum_height;
    float crank_centre; /* of the range that the angles are brought into, rad */
    float crank_lowest;
    float crank_highest;
    CrankLeg legs[LEGS];
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
