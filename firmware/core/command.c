#include "command.h"

#include <string.h>

#include "cycle.h"
#include "play.h"
#include "safety.h"
#include "table.h"

uint8_t command_counts(const uint8_t *payload, uint8_t length, uint16_t counts[MAX_JOINTS])
{
    if (length % 2 || length > 2 * MAX_JOINTS)
        return 0;
    for (uint8_t i = 0; i < length / 2; i++)
        counts[i] = get16(payload + 2 * i);
    return (uint8_t)(length / 2);
}

static bool are_counts(uint8_t length)
{
    return length && length % 2 == 0 && length <= 2 * MAX_JOINTS;
}

bool command_is_well_formed(const Frame *frame)
{
    switch (frame->type) {
    case TYPE_ARM:
        return are_counts(frame->length);
    case TYPE_CYCLE_AXIS:
        return frame->length == 11;
    case TYPE_TABLE_BEGIN:
        return frame->length == 4;
    case TYPE_TABLE_ROW:
        return frame->length > 2 && are_counts((uint8_t)(frame->length - 2));
    case TYPE_TABLE_END:
    case TYPE_PLAY:
        return frame->length == 2;
    default:
        return frame->length == 0;
    }
}

static float get_float(const uint8_t *at)
{
    float value;
    memcpy(&value, at, sizeof value); /* little endian, as the chip is */
    return value;
}

static uint8_t arm(const Frame *frame)
{
    uint16_t park[MAX_JOINTS];
    uint8_t joints = command_counts(frame->payload, frame->length, park);
    return safety_arm(park, joints);
}

static uint8_t take_row(const Frame *frame)
{
    uint16_t counts[MAX_JOINTS];
    uint8_t joints = command_counts(frame->payload + 2, (uint8_t)(frame->length - 2), counts);
    return table_row(get16(frame->payload), counts, joints);
}

static bool changes_program(uint8_t type)
{
    return type >= TYPE_CYCLE_AXIS && type <= TYPE_TABLE_END;
}

static uint8_t obey(const Frame *frame)
{
    const uint8_t *payload = frame->payload;
    if (changes_program(frame->type) && safety_is_playing())
        return RESULT_NO_PROGRAM; /* not the one that is being played */
    switch (frame->type) {
    case TYPE_ARM:
        return arm(frame);
    case TYPE_DISARM:
        return safety_disarm();
    case TYPE_CLEAR:
        return safety_clear();
    case TYPE_CYCLE_AXIS:
        return cycle_set(payload[0], get_float(payload + 1), get16(payload + 5),
                         get_float(payload + 7));
    case TYPE_TABLE_BEGIN:
        return table_begin(get16(payload), get16(payload + 2));
    case TYPE_TABLE_ROW:
        return take_row(frame);
    case TYPE_TABLE_END:
        return table_end(get16(payload));
    case TYPE_PLAY:
        return safety_play(payload[0], payload[1]);
    case TYPE_FINISH:
        play_finish();
        return RESULT_OK;
    default:
        return safety_stop();
    }
}

uint8_t command_obey(const Frame *frame)
{
    uint8_t result = obey(frame);
    if (result == RESULT_OK)
        safety_note_host(!changes_program(frame->type));
    return result;
}
