/* The conversation: announces the board, takes frames, answers, tells the state. */
#pragma once
#include <stdint.h>

void board_begin(uint8_t reset_cause);

/* One round: at most one frame, the deadlines, and the period's work where one has begun. */
void board_step(void);
