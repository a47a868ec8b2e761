/* Tables of pulse counts at equal time steps: one that the host uploads, one in flash.
 *
 * Safe state: no table. An upload is only there once its last row has come and its CRC fits.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* Each is an enum Result. Rows come in order from 0; a row is checked as a setpoint is. */
uint8_t table_begin(uint16_t rows, uint16_t step_ms);
uint8_t table_row(uint16_t index, const uint16_t *counts, uint8_t joints);
uint8_t table_end(uint16_t crc);

/* `program` is PROGRAM_TABLE or PROGRAM_FLASH_TABLE from here on. */
bool table_is_there(uint8_t program);

/* No servo is faster than it can be from row to row, and in a loop from the last to the first. */
bool table_is_slow_enough(uint8_t program, bool is_loop);

/* Seconds from the first row to the last, or in a loop to the first again. */
float table_duration(uint8_t program, bool is_loop);

/* The counts at `time` seconds within that duration, in a straight line between two rows. */
void table_at(uint8_t program, float time, float *counts);
