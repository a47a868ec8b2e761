#include "link.h"

#include <string.h>

#include "hardware.h"
#include "target.h"

/* Rings of 256 bytes: their indices wrap by themselves. */
static STATE volatile uint8_t received[256];
static STATE volatile uint8_t received_end;
static STATE volatile uint8_t received_start;

/* A bit for each place in `received`: the delimiter there ends a frame that lost bytes. */
static STATE volatile uint8_t cut[256 / 8];
static STATE bool is_cut;      /* the frame that is arriving has lost bytes */
static STATE bool is_end_owed; /* a frame has lost its delimiter */

static STATE uint8_t waiting[256];
static STATE volatile uint8_t waiting_start;
static STATE volatile uint8_t waiting_end;

static STATE uint8_t pending[MAX_STUFFED]; /* of the frame that is being read */
static STATE uint8_t pending_length;
static STATE bool is_too_long;

static STATE uint16_t sent;
static STATE uint16_t bad_frames;
static STATE uint16_t overruns;

static uint8_t bit_of(uint8_t place)
{
    return (uint8_t)(1 << (place & 7));
}

/* False where the ring is full. */
static bool store(uint8_t byte)
{
    uint8_t end = (uint8_t)(received_end + 1);
    if (end == received_start)
        return false;
    received[received_end] = byte;
    received_end = end;
    return true;
}

/* A delimiter, marked where it ends a frame that lost bytes; false where the ring is full. */
static bool store_end(bool is_of_cut_frame)
{
    uint8_t place = received_end;
    if (is_of_cut_frame)
        cut[place >> 3] |= bit_of(place);
    else
        cut[place >> 3] &= (uint8_t)~bit_of(place);
    return store(0);
}

/* Where the ring is full, the frame that is arriving loses its rest, and no other frame anything. */
void link_take_byte(uint8_t byte, bool is_after_loss)
{
    is_cut = is_cut || is_after_loss;
    if (byte == 0) {
        is_end_owed = !store_end(is_cut || is_end_owed);
        is_cut = false;
        return;
    }
    if (is_end_owed && !is_cut)
        is_end_owed = !store_end(true);
    is_cut = is_cut || is_end_owed || !store(byte);
}

bool link_next_byte(uint8_t *byte)
{
    if (waiting_start == waiting_end)
        return false;
    *byte = waiting[waiting_start++];
    return true;
}

/* The frame that the delimiter at a place has just ended; false where it is none. */
static bool finish(uint8_t place, Frame *frame)
{
    uint8_t length = pending_length;
    bool is_overrun = is_too_long || cut[place >> 3] & bit_of(place);
    pending_length = 0;
    is_too_long = false;
    if (is_overrun) {
        count_one(&overruns);
        return false;
    }
    if (length == 0)
        return false;
    if (!wire_decode(pending, length, frame)) {
        count_one(&bad_frames);
        return false;
    }
    return true;
}

bool link_receive(Frame *frame)
{
    while (received_start != received_end) {
        uint8_t place = received_start;
        uint8_t byte = received[place];
        bool is_whole = byte == 0 && finish(place, frame);
        received_start = (uint8_t)(place + 1); /* only now may the interrupt use the place again */
        if (is_whole)
            return true;
        if (byte == 0)
            continue;
        if (pending_length < MAX_STUFFED)
            pending[pending_length++] = byte;
        else
            is_too_long = true;
    }
    return false;
}

bool link_is_idle(void)
{
    return received_start == received_end;
}

static void send_bytes(const uint8_t *bytes, uint8_t length)
{
    uint8_t room = (uint8_t)(waiting_start - waiting_end - 1);
    if (room < length)
        return;
    uint8_t end = waiting_end;
    while (length--)
        waiting[end++] = *bytes++;
    waiting_end = end;
    hardware_start_sending();
}

void link_send_delimiter(void)
{
    static const uint8_t DELIMITER = 0;
    send_bytes(&DELIMITER, 1);
}

void link_send(uint8_t type, const uint8_t *payload, uint8_t length)
{
    Frame frame = {.type = type, .sequence = ++sent, .length = length};
    memcpy(frame.payload, payload, length);
    uint8_t wire[MAX_WIRE];
    send_bytes(wire, wire_encode(&frame, wire));
}

uint16_t link_bad_frames(void)
{
    return bad_frames;
}

uint16_t link_overruns(void)
{
    return overruns;
}
