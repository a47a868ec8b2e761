/* The stop button (D22, a contact that opens) and the start button (D23, a contact that closes).
 *
 * Both switch to ground, against the chip's own pull-ups. An open stop contact means stop, so a
 * broken wire stops too; where there is no stop button, D22 is bridged to ground.
 */
#pragma once
#include <stdbool.h>

void buttons_begin(void);

/* Reads both; call at least once a millisecond, it keeps the time itself. */
void buttons_read(void);

/* The stop contact has been open for 3 ms, and has not been closed for 30 ms since. */
bool buttons_is_stop(void);

/* True once for each time the start contact has been closed for 30 ms, after it was open for as
 * long: one that is closed at power-up starts nothing. */
bool buttons_take_start(void);
