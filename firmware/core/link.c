#include "link.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <string.h>

#include "machine.h"

/* Rings of 256 bytes: their indices wrap by themselves. */
static volatile uint8_t received[256];
static volatile uint8_t received_end;
static uint8_t received_start;
static volatile bool is_received_lost;

static uint8_t waiting[256];
static volatile uint8_t waiting_start;
static volatile uint8_t waiting_end;

static uint8_t pending[MAX_STUFFED]; /* of the frame that is arriving */
static uint8_t pending_length;
static bool is_skipping;

static uint16_t sent;
static uint16_t bad_frames;
static uint16_t overruns;

void link_begin(void)
{
    UCSR0A = _BV(U2X0);
    UBRR0 = (F_CPU / 8 + BAUD / 2) / BAUD - 1; /* the nearest, as machine.h has checked */
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = _BV(RXEN0) | _BV(TXEN0) | _BV(RXCIE0);
}

ISR(USART0_RX_vect)
{
    if (UCSR0A & _BV(DOR0))
        is_received_lost = true;
    uint8_t byte = UDR0;
    uint8_t end = received_end + 1;
    if (end == received_start) {
        is_received_lost = true;
    } else {
        received[received_end] = byte;
        received_end = end;
    }
}

ISR(USART0_UDRE_vect)
{
    UDR0 = waiting[waiting_start++];
    if (waiting_start == waiting_end)
        UCSR0B &= (uint8_t)~_BV(UDRIE0);
}

/* The frame that the delimiter has just ended; false where it is none. */
static bool finish(Frame *frame)
{
    uint8_t length = pending_length;
    pending_length = 0;
    if (is_skipping) {
        is_skipping = false;
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
        if (is_received_lost) {
            is_received_lost = false;
            is_skipping = true;
        }
        uint8_t byte = received[received_start++];
        if (byte == 0) {
            if (finish(frame))
                return true;
        } else if (pending_length < MAX_STUFFED) {
            pending[pending_length++] = byte;
        } else {
            is_skipping = true;
        }
    }
    return false;
}

bool link_is_idle(void)
{
    return received_start == received_end;
}

static void send_bytes(const uint8_t *bytes, uint8_t length)
{
    uint8_t room = waiting_start - waiting_end - 1;
    if (room < length)
        return;
    uint8_t end = waiting_end;
    while (length--)
        waiting[end++] = *bytes++;
    waiting_end = end;
    UCSR0B |= _BV(UDRIE0);
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
