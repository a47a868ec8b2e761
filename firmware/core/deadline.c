#include "deadline.h"

#include "hardware.h"
#include "target.h"

static STATE bool is_set;
static STATE uint32_t until_us;

void deadline_set(uint16_t ms)
{
    until_us = hardware_us() + (uint32_t)(1000UL * ms);
    is_set = true;
}

void deadline_forget(void)
{
    is_set = false;
}

bool deadline_has_passed(void)
{
    /* The clock may wrap in between: seconds apart, the difference still has its sign. */
    return is_set && (int32_t)(hardware_us() - until_us) >= 0;
}
