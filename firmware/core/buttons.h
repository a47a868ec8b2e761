/* The stop button (a contact that opens) and the start button (a contact that closes), debounced.
 *
 * An open stop contact means stop, so a broken wire stops too.
 */
#pragma once
#include <stdbool.h>

/* Reads both; call at least once a millisecond, it keeps the time itself. */
void buttons_read(void);

/* The stop contact has been open for 3 ms, and has not been closed for 30 ms since. */
bool buttons_is_stop(void);

/* True once for each time the start contact has been closed for 30 ms, after it was open for as
 * long: one that is closed at power-up starts nothing. */
bool buttons_take_start(void);
