#include "arming.h"

#include "clock.h"
#include "motion.h"
#include "target.h"

static STATE uint16_t park_counts[MAX_JOINTS];
static STATE uint32_t next_ms; /* when the next one's turn is */

void arming_begin(const uint16_t *park)
{
    for (uint8_t i = 0; i < MACHINE.joint_count; i++)
        park_counts[i] = park[i];
    next_ms = clock_period_ms();
}

bool arming_step(void)
{
    if ((int32_t)(clock_period_ms() - next_ms) < 0)
        return false;
    if (motion_is_all_on())
        return true;
    uint8_t channel = 0;
    while (motion_is_on(channel))
        channel++;
    motion_energise(channel, park_counts[channel]);
    next_ms = clock_period_ms() + MACHINE.arm_interval_ms;
    return false;
}
