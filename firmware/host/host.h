/* Boards on a computer, as many as one likes. Time is what the caller lets pass; nothing here looks
 * at a clock. Not for two threads at once, not even with two boards: they share the variables.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "hardware.h"
#include "machine.h"

/* What a board is wired to; it belongs to the caller, who may change it between two calls. */
typedef struct {
    Machine machine;
    FlashTable table;
    const uint16_t *table_counts; /* row by row */
    uint16_t battery_mv;
    bool is_stop_open;
    bool is_start_closed;
    bool has_encoders;
    uint16_t positions[MAX_JOINTS]; /* what they read, counts */
    uint8_t memory[MEMORY_BYTES];   /* outlives a reset */
    uint16_t pulses[MAX_JOINTS];    /* set by the board: counts that go out; 0: none */
    uint8_t mode;                   /* as well: enum Mode */
} Wires;

typedef struct Host Host;

/* Of a Wires, so that a caller in another language can see that it knows the same one. */
uint32_t host_size_of_wires(void);

/* A board that was switched on; null without memory. The wires must outlive it. */
Host *host_new(Wires *wires);
void host_free(Host *host);

/* Starts again, for the reason that HELLO will give; the first period begins at once. */
void host_reset(Host *host, uint8_t cause);

/* Lets microseconds pass; the program runs at least once a millisecond, and once for 0. Returns
   how many are left until the next period of pulses begins. */
uint32_t host_run(Host *host, uint32_t us);

/* Bytes from the host; the program runs after each one, as the chip's does. */
void host_feed(Host *host, const uint8_t *bytes, uint32_t length);

/* The same while the program is busy with something else: it runs at the next call only. */
void host_receive(Host *host, const uint8_t *bytes, uint32_t length);

/* Bytes for the host since the last call, at most `room`; how many. What nobody takes is lost. */
uint32_t host_take(Host *host, uint8_t *bytes, uint32_t room);
