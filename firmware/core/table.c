#include "table.h"

#include <avr/pgmspace.h>
#include <math.h>

#include "protocol.h"
#include "servo.h"
#include "wire.h"

#ifdef HAS_FLASH_TABLE
#include "flash_table.h"
#else
#define FLASH_TABLE_ROWS 0
#define FLASH_TABLE_STEP_MS 0
#define FLASH_TABLE_LOOPS 0
#endif

/* What 8 kB leave beside the rings, the stack and the rest. */
enum { TABLE_BYTES = 5376, ROWS = TABLE_BYTES / (2 * JOINT_COUNT), MIN_STEP_MS = 20 };

static const float STEP[JOINT_COUNT] = STEP_COUNTS;
#define PERIODS_A_MS 0.05f

static uint16_t uploaded[ROWS][JOINT_COUNT];
static uint16_t uploaded_rows;
static uint16_t rows_wanted;
static uint16_t uploaded_step_ms;
static bool is_whole;
/* Kept up to date row by row: over a whole table neither could be computed in one go without
 * keeping the loop from the stop button and the deadlines. */
static uint16_t crc_so_far;
static bool is_slow_so_far;

#if FLASH_TABLE_ROWS
static const uint16_t FLASHED[FLASH_TABLE_ROWS][JOINT_COUNT] PROGMEM = FLASH_TABLE;
#endif

/* No servo is faster than it can be on the way between two rows that were uploaded. */
static bool is_way_slow_enough(const uint16_t *from, const uint16_t *to)
{
    float periods = uploaded_step_ms * PERIODS_A_MS;
    for (uint8_t i = 0; i < JOINT_COUNT; i++)
        if (fabsf((float)to[i] - (float)from[i]) > STEP[i] * periods)
            return false;
    return true;
}

static void take_up(const uint16_t *counts)
{
    if (uploaded_rows && !is_way_slow_enough(uploaded[uploaded_rows - 1], counts))
        is_slow_so_far = false;
    for (uint8_t i = 0; i < JOINT_COUNT; i++) {
        uploaded[uploaded_rows][i] = counts[i];
        crc_so_far = wire_crc(crc_so_far, (uint8_t)counts[i]);
        crc_so_far = wire_crc(crc_so_far, (uint8_t)(counts[i] >> 8));
    }
    uploaded_rows++;
}

uint8_t table_begin(uint16_t rows, uint16_t step_ms)
{
    is_whole = false;
    uploaded_rows = rows_wanted = 0;
    crc_so_far = 0xFFFF;
    is_slow_so_far = true;
    if (rows > ROWS)
        return RESULT_TOO_LARGE;
    if (rows < 2 || step_ms < MIN_STEP_MS)
        return RESULT_BAD_TABLE;
    rows_wanted = rows;
    uploaded_step_ms = step_ms;
    return RESULT_OK;
}

uint8_t table_row(uint16_t index, const uint16_t *counts, uint8_t joints)
{
    if (is_whole || index != uploaded_rows || index >= rows_wanted)
        return RESULT_BAD_TABLE;
    if (joints != JOINT_COUNT)
        return RESULT_WRONG_JOINTS;
    if (servo_out_of_range(counts) != NO_JOINT)
        return RESULT_OUT_OF_RANGE;
    take_up(counts);
    return RESULT_OK;
}

uint8_t table_end(uint16_t crc)
{
    is_whole = rows_wanted != 0 && uploaded_rows == rows_wanted && crc == crc_so_far;
    return is_whole ? RESULT_OK : RESULT_BAD_TABLE;
}

bool table_is_there(uint8_t program)
{
    return program == PROGRAM_TABLE ? is_whole : FLASH_TABLE_ROWS != 0;
}

static uint16_t rows_of(uint8_t program)
{
    return program == PROGRAM_TABLE ? uploaded_rows : FLASH_TABLE_ROWS;
}

static uint16_t step_ms_of(uint8_t program)
{
    return program == PROGRAM_TABLE ? uploaded_step_ms : FLASH_TABLE_STEP_MS;
}

static uint16_t count_at(uint8_t program, uint16_t row, uint8_t joint)
{
#if FLASH_TABLE_ROWS
    if (program == PROGRAM_FLASH_TABLE)
        return pgm_read_word_far(pgm_get_far_address(FLASHED) + 2UL * (row * JOINT_COUNT + joint));
#endif
    (void)program;
    return uploaded[row][joint];
}

bool table_is_slow_enough(uint8_t program, bool is_loop)
{
    if (program == PROGRAM_FLASH_TABLE) /* its rows were checked when its header was made */
        return !is_loop || FLASH_TABLE_LOOPS;
    if (is_loop && !is_way_slow_enough(uploaded[uploaded_rows - 1], uploaded[0]))
        return false;
    return is_slow_so_far;
}

float table_duration(uint8_t program, bool is_loop)
{
    return 1e-3f * step_ms_of(program) * (rows_of(program) - (is_loop ? 0 : 1));
}

void table_at(uint8_t program, float time, float counts[JOINT_COUNT])
{
    uint16_t rows = rows_of(program);
    float place = time * 1000.0f / step_ms_of(program);
    uint16_t row = (uint16_t)place;
    if (row >= rows)
        row = rows - 1;
    float part = place - row;
    uint16_t after = row + 1 == rows ? 0 : row + 1;
    for (uint8_t i = 0; i < JOINT_COUNT; i++) {
        float from = count_at(program, row, i);
        counts[i] = part > 0 ? from + part * (count_at(program, after, i) - from) : from;
    }
}
