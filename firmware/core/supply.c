#include "supply.h"

#include "battery.h"
#include "clock.h"
#include "machine.h"

#define EXHAUSTED_AFTER_MS 500

static const uint16_t MINIMUM_MV = MINIMUM_BATTERY_MV; /* 0 where no battery is watched */

static uint16_t millivolts;
static bool is_low;
static uint32_t low_since_ms;

void supply_watch(void)
{
    bool was_low = is_low;
    millivolts = battery_mv();
    is_low = millivolts < MINIMUM_MV;
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
