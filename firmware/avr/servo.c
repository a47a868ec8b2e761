#include "servo.h"

#include <avr/io.h>
#include <util/atomic.h>

#include "clock.h"
#include "protocol.h"

typedef struct {
    volatile uint16_t *width;
    volatile uint8_t *control;
    volatile uint8_t *direction;
    uint8_t connect; /* bit of `control` that gives the pin to the timer */
    uint8_t pin;     /* bit of `direction` */
} Channel;

/* Arduino pins D6 D7 D8, D46 D45 D44, D11 D12: docs/wiring.md. */
static const Channel CHANNELS[] = {
    {&OCR4A, &TCCR4A, &DDRH, _BV(COM4A1), _BV(PH3)},
    {&OCR4B, &TCCR4A, &DDRH, _BV(COM4B1), _BV(PH4)},
    {&OCR4C, &TCCR4A, &DDRH, _BV(COM4C1), _BV(PH5)},
    {&OCR5A, &TCCR5A, &DDRL, _BV(COM5A1), _BV(PL3)},
    {&OCR5B, &TCCR5A, &DDRL, _BV(COM5B1), _BV(PL4)},
    {&OCR5C, &TCCR5A, &DDRL, _BV(COM5C1), _BV(PL5)},
    {&OCR1A, &TCCR1A, &DDRB, _BV(COM1A1), _BV(PB5)},
    {&OCR1B, &TCCR1A, &DDRB, _BV(COM1B1), _BV(PB6)},
};
_Static_assert(JOINT_COUNT <= sizeof CHANNELS / sizeof *CHANNELS, "more joints than channels");

static const uint16_t LOWEST[JOINT_COUNT] = LOWEST_COUNTS;
static const uint16_t HIGHEST[JOINT_COUNT] = HIGHEST_COUNTS;

static volatile uint16_t staged[JOINT_COUNT];
static volatile uint8_t staged_on;

void servo_begin(void)
{
    for (uint8_t i = 0; i < JOINT_COUNT; i++)
        *CHANNELS[i].direction |= CHANNELS[i].pin;
    /* Mode 14 as timer 1, and in step with it: none has a pulse under way at LATCH. */
    ICR4 = PERIOD_COUNTS - 1;
    ICR5 = PERIOD_COUNTS - 1;
    TCCR4A = _BV(WGM41);
    TCCR5A = _BV(WGM51);
    TCCR4B = _BV(WGM43) | _BV(WGM42) | _BV(CS41);
    TCCR5B = _BV(WGM53) | _BV(WGM52) | _BV(CS51);
    TCNT4 = TCNT1;
    TCNT5 = TCNT1;
}

uint8_t servo_out_of_range(const uint16_t counts[JOINT_COUNT])
{
    for (uint8_t i = 0; i < JOINT_COUNT; i++)
        if (counts[i] < LOWEST[i] || counts[i] > HIGHEST[i])
            return i;
    return NO_JOINT;
}

bool servo_stage(const uint16_t counts[JOINT_COUNT], uint8_t is_on, uint8_t periods)
{
    uint16_t widths[JOINT_COUNT];
    for (uint8_t i = 0; i < JOINT_COUNT; i++) {
        uint16_t count = counts[i];
        count = count < LOWEST[i] ? LOWEST[i] : count > HIGHEST[i] ? HIGHEST[i] : count;
        widths[i] = count - 1; /* a compare value of n makes a pulse of n + 1 counts */
    }
    bool is_in_time;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
        is_in_time = clock_periods() == periods;
        if (is_in_time) {
            for (uint8_t i = 0; i < JOINT_COUNT; i++)
                staged[i] = widths[i];
            staged_on = is_on;
        }
    }
    return is_in_time;
}

void servo_latch(void)
{
    uint8_t on = staged_on;
    for (uint8_t i = 0; i < JOINT_COUNT; i++, on >>= 1) {
        const Channel *channel = &CHANNELS[i];
        *channel->width = staged[i];
        if (on & 1)
            *channel->control |= channel->connect;
        else
            *channel->control &= (uint8_t)~channel->connect;
    }
}
