#include "table.h"

#include <math.h>

#include "counts.h"
#include "hardware.h"
#include "target.h"
#include "wire.h"

/* What 8 kB leave beside the rings, the stack and the rest. */
enum { TABLE_COUNTS = 2688, MIN_STEP_MS = 20 };

#define PERIODS_A_MS 0.05f

static STATE uint16_t uploaded[TABLE_COUNTS]; /* row by row */
static STATE uint16_t uploaded_rows;
static STATE uint16_t rows_announced;
static STATE uint16_t uploaded_step_ms;
static STATE bool is_whole;
/* Kept up to date row by row: over a whole table neither could be computed in one go without
 * keeping the loop from the stop button and the deadlines. */
static STATE uint16_t crc_so_far;
static STATE bool is_slow_so_far;

static uint16_t *uploaded_row(uint16_t row)
{
    return uploaded + row * MACHINE.joint_count;
}

/* No servo is faster than it can be from one uploaded row to another. */
static bool is_step_slow_enough(const uint16_t *from, const uint16_t *to)
{
    float periods = uploaded_step_ms * PERIODS_A_MS;
    for (uint8_t i = 0; i < MACHINE.joint_count; i++)
        if (fabsf((float)to[i] - (float)from[i]) > MACHINE.step_counts[i] * periods)
            return false;
    return true;
}

static void append(const uint16_t *counts)
{
    uint16_t *row = uploaded_row(uploaded_rows);
    if (uploaded_rows && !is_step_slow_enough(row - MACHINE.joint_count, counts))
        is_slow_so_far = false;
    for (uint8_t i = 0; i < MACHINE.joint_count; i++) {
        row[i] = counts[i];
        crc_so_far = wire_crc(crc_so_far, (uint8_t)counts[i]);
        crc_so_far = wire_crc(crc_so_far, (uint8_t)(counts[i] >> 8));
    }
    uploaded_rows++;
}

uint8_t table_begin(uint16_t rows, uint16_t step_ms)
{
    is_whole = false;
    uploaded_rows = rows_announced = 0;
    crc_so_far = 0xFFFF;
    is_slow_so_far = true;
    if (rows > TABLE_COUNTS / MACHINE.joint_count)
        return RESULT_TOO_LARGE;
    if (rows < 2 || step_ms < MIN_STEP_MS)
        return RESULT_BAD_TABLE;
    rows_announced = rows;
    uploaded_step_ms = step_ms;
    return RESULT_OK;
}

uint8_t table_row(uint16_t index, const uint16_t *counts, uint8_t joints)
{
    if (is_whole || index != uploaded_rows || index >= rows_announced)
        return RESULT_BAD_TABLE;
    if (joints != MACHINE.joint_count)
        return RESULT_WRONG_JOINTS;
    if (counts_out_of_range(counts) != NO_JOINT)
        return RESULT_OUT_OF_RANGE;
    append(counts);
    return RESULT_OK;
}

uint8_t table_end(uint16_t crc)
{
    is_whole = rows_announced != 0 && uploaded_rows == rows_announced && crc == crc_so_far;
    return is_whole ? RESULT_OK : RESULT_BAD_TABLE;
}

static uint16_t rows_of(uint8_t program)
{
    return program == PROGRAM_TABLE ? uploaded_rows : hardware_flash_table().rows;
}

static uint16_t step_ms_of(uint8_t program)
{
    return program == PROGRAM_TABLE ? uploaded_step_ms : hardware_flash_table().step_ms;
}

static uint16_t count_at(uint8_t program, uint16_t row, uint8_t joint)
{
    if (program == PROGRAM_TABLE)
        return uploaded_row(row)[joint];
    return hardware_flash_count(row, joint);
}

bool table_is_there(uint8_t program)
{
    return program == PROGRAM_TABLE ? is_whole : rows_of(program) != 0;
}

bool table_is_slow_enough(uint8_t program, bool is_loop)
{
    if (program == PROGRAM_FLASH_TABLE) /* its rows were checked when its header was made */
        return !is_loop || hardware_flash_table().can_loop;
    if (is_loop && !is_step_slow_enough(uploaded_row((uint16_t)(uploaded_rows - 1)), uploaded))
        return false;
    return is_slow_so_far;
}

float table_duration(uint8_t program, bool is_loop)
{
    return 1e-3f * step_ms_of(program) * (float)(rows_of(program) - (is_loop ? 0 : 1));
}

void table_at(uint8_t program, float time, float *counts)
{
    uint16_t rows = rows_of(program);
    float place = fmaxf(time, 0) * 1000.0f / step_ms_of(program);
    uint16_t row = (uint16_t)(rows - 1);
    if (place < rows)
        row = (uint16_t)place;
    float part = place - row;
    uint16_t after = row + 1 == rows ? 0 : (uint16_t)(row + 1);
    for (uint8_t i = 0; i < MACHINE.joint_count; i++) {
        float from = count_at(program, row, i);
        counts[i] = part > 0 ? from + part * (count_at(program, after, i) - from) : from;
    }
}
