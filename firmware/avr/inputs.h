/* What the chip reads: the battery's voltage, through a divider of two equal resistors on A0, and
 * the contacts of stop (D22) and start (D23), which switch to ground.
 *
 * Where there is no stop button, D22 is bridged to ground: an open contact means stop.
 */
#pragma once

void inputs_begin(void);
