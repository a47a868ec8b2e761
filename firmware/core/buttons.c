#include "buttons.h"

#include <stdint.h>

#include "hardware.h"
#include "target.h"

enum { OPEN_MS = 3, CLOSED_MS = 30 };

/* A contact, and for how long it has been read otherwise. */
typedef struct {
    bool is_closed;
    uint8_t disagrees_ms;
} Contact;

static STATE Contact stop = {.is_closed = true};
static STATE Contact start = {.is_closed = true}; /* until it was seen open */
static STATE bool is_start_pressed;
static STATE uint16_t read_ms;

/* One reading, a millisecond after the last; true when the contact has changed. */
static bool read_contact(Contact *contact, bool is_closed, uint8_t needed_ms)
{
    if (is_closed == contact->is_closed) {
        contact->disagrees_ms = 0;
        return false;
    }
    if (++contact->disagrees_ms < needed_ms)
        return false;
    *contact = (Contact){.is_closed = is_closed};
    return true;
}

void buttons_read(void)
{
    uint16_t ms = (uint16_t)(hardware_us() / 1000);
    if (ms == read_ms)
        return;
    read_ms = ms;
    bool is_stop_closed = !hardware_is_stop_open();
    read_contact(&stop, is_stop_closed, is_stop_closed ? CLOSED_MS : OPEN_MS);
    if (read_contact(&start, hardware_is_start_closed(), CLOSED_MS))
        is_start_pressed = is_start_pressed || start.is_closed;
}

bool buttons_is_stop(void)
{
    return !stop.is_closed;
}

bool buttons_take_start(void)
{
    bool was_pressed = is_start_pressed;
    is_start_pressed = false;
    return was_pressed;
}
