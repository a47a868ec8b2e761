/* All that the program needs of the hardware: avr/ has it for the chip, host/ for a computer.
 *
 * Each of the two also has a target.h. It defines MACHINE (machine.h), and STATE, which marks every
 * variable that outlives a call: on a computer many boards take turns with the same variables.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "protocol.h"

/* Time. A period of 20 ms begins at each latch: then, and only then, the pulses change. */

/* How many periods have begun. */
uint32_t hardware_periods(void);

/* Microseconds since the first period began; wraps after 71 minutes. */
uint32_t hardware_us(void);

/* Pulses. Safe state: none. */

/* What the next latch puts out, unless `periods` is no longer the number of periods: then false,
 * and nothing has changed. Bit i of `is_on`: channel i has pulses; counts of half a microsecond. */
bool hardware_stage_pulses(const uint16_t counts[MAX_JOINTS], uint32_t is_on, uint32_t periods);

/* What encoders measure, in counts; false where there are none. */
bool hardware_read_positions(uint16_t counts[MAX_JOINTS]);

/* Bytes. The hardware hands in what arrives (link_take_byte), and asks for what is to be sent
 * (link_next_byte) from this call on until there is nothing more. */
void hardware_start_sending(void);

/* Contacts and supply. */

bool hardware_is_stop_open(void);
bool hardware_is_start_closed(void);

/* Millivolts, as measured last. Call once a period. */
uint16_t hardware_battery_mv(void);

/* Memory that lasts when the power goes, MEMORY_BYTES of it. */

enum { MEMORY_BYTES = 160 };

bool hardware_is_memory_ready(void);
uint8_t hardware_read_memory(uint16_t address);

/* One byte, if it has changed; only while the memory is ready. */
void hardware_write_memory(uint16_t address, uint8_t value);

/* A table that was loaded together with the program. */

typedef struct {
    uint16_t rows; /* 0: there is none */
    uint16_t step_ms;
    bool can_loop; /* no servo is outrun from the last row to the first */
} FlashTable;

FlashTable hardware_flash_table(void);
uint16_t hardware_flash_count(uint16_t row, uint8_t joint);

/* Resets the board unless it is called four times a second. */
void hardware_feed_watchdog(void);
