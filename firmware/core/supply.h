/* Whether the battery has what the servos need: a dip is not yet an empty battery. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* Looks at the battery; call once a period. */
void supply_watch(void);

/* Millivolts, as measured last. */
uint16_t supply_mv(void);

/* Below what the machine file requires, now. */
bool supply_is_low(void);

/* It has been for half a second. */
bool supply_is_exhausted(void);
