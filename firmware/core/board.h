/* The conversation: announces the board, takes frames, answers, reports the state. */
#pragma once
#include <stdint.h>

/* Once, before the first round. */
void board_begin(uint8_t reset_cause);

/* One round: at most one frame, the deadlines, and the period's work where one has begun. */
void board_step(void);
