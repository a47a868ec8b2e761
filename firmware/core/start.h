/* The start button: a machine without a host. */
#pragma once

/* Looks at the button; call in every round of the loop, after safety_watch.
 *
 * Disarmed: arms where the program begins and plays it in a loop. Playing: ends it. Stopped: clears,
 * and moves nothing. A machine that a host drives is the host's. */
void start_watch(void);
