#include "cycle.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "hardware.h"
#include "kinematics.h"
#include "target.h"
#include "wire.h"

enum { AXES = 6, LONGEST_S = 60, HIGHEST_MHZ = 25000, COPIES = 2 };
#define TURN 6.2831853f

typedef struct {
    float amplitude;
    float phase;
    uint16_t frequency_mhz;
    uint16_t unused;
} Axis;

typedef struct {
    Axis axes[AXES];
    uint16_t number; /* of two copies that are whole, the higher one is the newer, modulo 65536 */
    uint16_t crc;
} Kept;
_Static_assert(COPIES * sizeof(Kept) <= MEMORY_BYTES, "the memory is too small");

static STATE Kept kept;
static STATE uint8_t copy;               /* the one in memory that is whole */
static STATE uint8_t next = sizeof kept; /* which byte of the other one is written next */

static uint16_t address_of(uint8_t which, uint8_t byte)
{
    return (uint16_t)(which * sizeof kept + byte);
}

static uint16_t crc_of(const Kept *it)
{
    uint16_t crc = 0xFFFF;
    for (uint8_t i = 0; i < offsetof(Kept, crc); i++)
        crc = wire_crc(crc, ((const uint8_t *)it)[i]);
    return crc;
}

/* False, and zeros, where that copy is damaged. */
static bool read_copy(uint8_t which, Kept *it)
{
    for (uint8_t i = 0; i < sizeof *it; i++)
        ((uint8_t *)it)[i] = hardware_read_memory(address_of(which, i));
    bool is_whole = it->crc == crc_of(it);
    if (!is_whole)
        memset(it, 0, sizeof *it);
    return is_whole;
}

void cycle_begin(void)
{
    Kept other = {0};
    bool is_whole = read_copy(0, &kept);
    if (!read_copy(1, &other))
        return;
    if (!is_whole || (int16_t)(uint16_t)(other.number - kept.number) > 0) {
        kept = other;
        copy = 1;
    }
}

/* A byte in turn, so that nothing ever waits: it takes 76 periods. The CRC comes last; until it is
 * there, the copy is none. */
void cycle_keep(void)
{
    uint8_t older = copy ? 0 : 1;
    if (next == sizeof kept || !hardware_is_memory_ready())
        return;
    hardware_write_memory(address_of(older, next), ((const uint8_t *)&kept)[next]);
    if (++next == sizeof kept)
        copy = older;
}

uint8_t cycle_set(uint8_t axis, float amplitude, uint16_t frequency_mhz, float phase)
{
    if (!MACHINE.hexapod.is_known)
        return RESULT_NO_PROGRAM;
    if (axis >= AXES || !isfinite(amplitude) || !isfinite(phase) || frequency_mhz > HIGHEST_MHZ)
        return RESULT_OUT_OF_RANGE;
    kept.axes[axis] = (Axis){amplitude, fmodf(phase, TURN), frequency_mhz, 0};
    if (next == sizeof kept)
        kept.number++;
    kept.crc = crc_of(&kept);
    next = 0;
    return RESULT_OK;
}

static bool is_moving(const Axis *axis)
{
    return axis->amplitude != 0 && axis->frequency_mhz != 0;
}

bool cycle_is_there(void)
{
    if (!MACHINE.hexapod.is_known)
        return false;
    for (uint8_t i = 0; i < AXES; i++)
        if (is_moving(&kept.axes[i]))
            return true;
    return false;
}

static uint16_t common_divisor(uint16_t a, uint16_t b)
{
    while (b) {
        uint16_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

float cycle_duration(void)
{
    uint16_t slowest_mhz = 0;
    for (uint8_t i = 0; i < AXES; i++)
        if (is_moving(&kept.axes[i]))
            slowest_mhz = common_divisor(kept.axes[i].frequency_mhz, slowest_mhz);
    if (slowest_mhz * (uint32_t)LONGEST_S < 1000)
        return 0;
    return 1000.0f / slowest_mhz;
}

bool cycle_at(float time, float part, float *counts)
{
    float offset[AXES];
    for (uint8_t i = 0; i < AXES; i++) {
        /* Whole turns are left out first: what is left keeps its digits. */
        float turns = time * kept.axes[i].frequency_mhz * 1e-3f;
        float angle = TURN * (turns - floorf(turns)) + kept.axes[i].phase;
        offset[i] = part * kept.axes[i].amplitude * sinf(angle);
    }
    const CrankHexapod *hexapod = &MACHINE.hexapod;
    float position[3], rotation[9], cranks[LEGS];
    for (uint8_t k = 0; k < 3; k++)
        position[k] = hexapod->home_position[k] + offset[k];
    kinematics_turned(offset + 3, hexapod->home_rotation, rotation);
    if (!kinematics_cranks(&MACHINE.hexapod, position, rotation, cranks))
        return false;
    kinematics_counts(&MACHINE.hexapod, cranks, counts);
    return kinematics_is_within_limits(&MACHINE.hexapod, position, cranks);
}
