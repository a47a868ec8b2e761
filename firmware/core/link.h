/* The serial line: bytes to frames and back.
 *
 * The hardware's interrupts only move bytes between its registers and two rings. Safe state: what
 * is damaged, too long or incomplete is dropped and counted; the next delimiter starts afresh.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "wire.h"

/* For the hardware, also within an interrupt: a byte has arrived, `is_after_loss` where others
 * before it were lost. */
void link_take_byte(uint8_t byte, bool is_after_loss);

/* As well: the next byte to be sent; false where there is none. */
bool link_next_byte(uint8_t *byte);

/* The next whole frame, if one has arrived; looks at no more bytes than the ring holds. */
bool link_receive(Frame *frame);

/* Sends a frame under the next sequence number; where the ring has no room for it, it is lost. */
void link_send(uint8_t type, const uint8_t *payload, uint8_t length);

/* A delimiter alone: ends whatever half a frame the other end may have got before. */
void link_send_delimiter(void);

/* Frames whose bytes were damaged, and frames that were too long or not taken in time. */
uint16_t link_bad_frames(void);
uint16_t link_overruns(void);

/* Nothing waits to be read. */
bool link_is_idle(void);

/* One more, but never round to zero. */
static inline void count_one(uint16_t *counter)
{
    if (*counter != UINT16_MAX)
        ++*counter;
}
