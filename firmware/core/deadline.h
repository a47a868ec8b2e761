/* How long the host may be silent: until when the next setpoint must have come.
 *
 * Safe state: none is set, which never passes; safety.c sets one wherever the board is armed.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* In so many milliseconds from now; takes the place of the one before. */
void deadline_set(uint16_t ms);

void deadline_forget(void);

/* One is set, and is over; ask in every round of the loop. */
bool deadline_has_passed(void);
