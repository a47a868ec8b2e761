/* Playing a program: checked first, then from where the joints are, smoothly up to speed, once or
 * in a loop, and smoothly to an end.
 *
 * Safe state: idle. safety.c decides when a program may run; what is put out here is aimed at
 * through motion.c, which no servo outruns.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

enum PlayStep { PLAY_CHECKING, PLAY_MOVING, PLAY_DONE, PLAY_UNREACHABLE, PLAY_TOO_FAST };

/* Whether there is such a program; an enum Result. */
uint8_t play_has(uint8_t program);

/* Where the program begins; false where that is out of reach. */
bool play_start_counts(uint8_t program, uint16_t *counts);

/* Gets ready to check and play it from the present joints on; an enum Result. */
uint8_t play_begin(uint8_t program, bool is_loop);

/* Comes to an end smoothly from now on. */
void play_finish(void);

/* One period further; an enum PlayStep. */
uint8_t play_step(void);

/* When in the program something was wrong, in milliseconds. */
uint16_t play_trouble_ms(void);
