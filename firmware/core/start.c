#include "start.h"

#include "buttons.h"
#include "play.h"
#include "safety.h"

/* What the start button plays: what was uploaded, else what is in flash, else the cycle. */
static uint8_t program_to_start(void)
{
    static const uint8_t CHOICE[] = {PROGRAM_TABLE, PROGRAM_FLASH_TABLE, PROGRAM_CYCLE};
    for (uint8_t i = 0; i < sizeof CHOICE; i++)
        if (play_has(CHOICE[i]) == RESULT_OK)
            return CHOICE[i];
    return 0;
}

static void press(void)
{
    uint8_t program = program_to_start();
    uint16_t start[MAX_JOINTS] = {0};
    switch (safety_mode()) {
    case MODE_STOPPED:
    case MODE_FAULT:
        safety_clear();
        break;
    case MODE_CHECKING:
    case MODE_PLAYING:
        play_finish();
        break;
    case MODE_ARMED:
    case MODE_HOLDING:
        if (!safety_is_hosts())
            safety_play(program, true);
        break;
    case MODE_DISARMED:
        if (program && play_start_counts(program, start))
            safety_arm_to_play(start, program);
        break;
    }
}

void start_watch(void)
{
    if (buttons_take_start() && !buttons_is_stop())
        press();
}
