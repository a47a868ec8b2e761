/* Servo after servo gets its first pulse: all at once would pull more than a supply has.
 *
 * Safe state: none is energised unless arming_step is called.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* From the next step on, at these counts, one for each joint; they must be in range. */
void arming_begin(const uint16_t *park);

/* Energises the next servo when it is its turn; true when all are on and the last one has had its
 * time. Call once a period. */
bool arming_step(void);
