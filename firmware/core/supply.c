#include "supply.h"

#include "clock.h"
#include "target.h"

#define EXHAUSTED_AFTER_MS 500

static STATE uint16_t millivolts;
static STATE bool is_low;
static STATE uint32_t low_since_ms;

void supply_watch(void)
{
    bool was_low = is_low;
    millivolts = hardware_battery_mv();
    is_low = millivolts < MACHINE.minimum_battery_mv;
    if (!was_low)
        low_since_ms = clock_period_ms();
}

uint16_t supply_mv(void)
{
    return millivolts;
}

bool supply_is_low(void)
{
    return is_low;
}

bool supply_is_exhausted(void)
{
    return is_low && clock_period_ms() - low_since_ms >= EXHAUSTED_AFTER_MS;
}
