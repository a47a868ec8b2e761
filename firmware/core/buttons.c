#include "buttons.h"

#include <avr/io.h>
#include <stdint.h>

#include "clock.h"

enum { STOP_PIN = _BV(PA0), START_PIN = _BV(PA1), OPEN_MS = 3, CLOSED_MS = 30 };

static bool is_stop;
static uint8_t stop_disagrees_ms;
static bool is_start_closed = true; /* until it was seen open: a stuck contact starts nothing */
static uint8_t start_disagrees_ms;
static bool is_start_wanted;
static uint16_t read_ms;

void buttons_begin(void)
{
    PORTA = STOP_PIN | START_PIN;
}

void buttons_read(void)
{
    uint16_t ms = (uint16_t)(clock_us() / 1000);
    if (ms == read_ms)
        return;
    read_ms = ms;
    uint8_t open = PINA;

    bool is_open = open & STOP_PIN;
    stop_disagrees_ms = is_open == is_stop ? 0 : stop_disagrees_ms + 1;
    if (stop_disagrees_ms >= (is_open ? OPEN_MS : CLOSED_MS)) {
        is_stop = is_open;
        stop_disagrees_ms = 0;
    }

    bool is_closed = !(open & START_PIN);
    start_disagrees_ms = is_closed == is_start_closed ? 0 : start_disagrees_ms + 1;
    if (start_disagrees_ms >= CLOSED_MS) {
        is_start_closed = is_closed;
        is_start_wanted = is_start_wanted || is_closed;
        start_disagrees_ms = 0;
    }
}

bool buttons_is_stop(void)
{
    return is_stop;
}

bool buttons_take_start(void)
{
    bool is_wanted = is_start_wanted;
    is_start_wanted = false;
    return is_wanted;
}
