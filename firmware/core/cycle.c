#include "cycle.h"

#include <math.h>

#include "kinematics.h"
#include "protocol.h"
#include "wire.h"

#if HAS_KINEMATICS

#include <avr/eeprom.h>
#include <string.h>

enum { AXES = 6, LONGEST_S = 60, HIGHEST_MHZ = 25000 };
#define TURN 6.2831853f

typedef struct {
    float amplitude;
    uint16_t frequency_mhz;
    float phase;
} Axis;

typedef struct {
    Axis axes[AXES];
    uint16_t crc;
} Kept;

static Kept kept;
static Axis *const axes = kept.axes;
static Kept in_eeprom EEMEM;

static uint16_t crc_of_axes(void)
{
    uint16_t crc = 0xFFFF;
    for (uint8_t i = 0; i < sizeof kept.axes; i++)
        crc = wire_crc(crc, ((const uint8_t *)kept.axes)[i]);
    return crc;
}

void cycle_begin(void)
{
    eeprom_read_block(&kept, &in_eeprom, sizeof kept);
    if (kept.crc != crc_of_axes())
        memset(&kept, 0, sizeof kept);
}

/* All bytes in turn: a change is kept after at most 62 periods, and nothing ever waits. */
void cycle_keep(void)
{
    static uint8_t next;
    if (!eeprom_is_ready())
        return;
    eeprom_update_byte((uint8_t *)&in_eeprom + next, ((const uint8_t *)&kept)[next]);
    next = next + 1 == sizeof kept ? 0 : next + 1;
}

uint8_t cycle_set(uint8_t axis, float amplitude, uint16_t frequency_mhz, float phase)
{
    if (axis >= AXES || !isfinite(amplitude) || !isfinite(phase) || frequency_mhz > HIGHEST_MHZ)
        return RESULT_OUT_OF_RANGE;
    axes[axis] = (Axis){amplitude, frequency_mhz, fmodf(phase, TURN)};
    kept.crc = crc_of_axes();
    return RESULT_OK;
}

static bool is_moving(const Axis *axis)
{
    return axis->amplitude != 0 && axis->frequency_mhz != 0;
}

bool cycle_is_there(void)
{
    for (uint8_t i = 0; i < AXES; i++)
        if (is_moving(&axes[i]))
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
        if (is_moving(&axes[i]))
            slowest_mhz = common_divisor(axes[i].frequency_mhz, slowest_mhz);
    if (slowest_mhz * (uint32_t)LONGEST_S < 1000)
        return 0;
    return 1000.0f / slowest_mhz;
}

bool cycle_at(float time, float part, float counts[JOINT_COUNT])
{
    float offset[AXES];
    for (uint8_t i = 0; i < AXES; i++) {
        /* Whole turns are left out first: what is left keeps its digits. */
        float turns = time * axes[i].frequency_mhz * 1e-3f;
        float angle = TURN * (turns - floorf(turns)) + axes[i].phase;
        offset[i] = part * axes[i].amplitude * sinf(angle);
    }
    const float position[3] = {offset[0], offset[1], offset[2] + HOME_HEIGHT_M};
    float rotation[9], cranks[LEGS];
    kinematics_rotation(offset + 3, rotation);
    if (!kinematics_cranks(position, rotation, cranks))
        return false;
    kinematics_counts(cranks, counts);
    return kinematics_is_within_limits(position, cranks);
}

#else /* a machine whose kinematics the board does not know */

void cycle_begin(void)
{
}

void cycle_keep(void)
{
}

uint8_t cycle_set(uint8_t axis, float amplitude, uint16_t frequency_mhz, float phase)
{
    (void)axis, (void)amplitude, (void)frequency_mhz, (void)phase;
    return RESULT_NO_PROGRAM;
}

bool cycle_is_there(void)
{
    return false;
}

float cycle_duration(void)
{
    return 0;
}

bool cycle_at(float time, float part, float counts[JOINT_COUNT])
{
    (void)time, (void)part, (void)counts;
    return false;
}

#endif
