#include "pulses.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/atomic.h>

#include "chip_clock.h"
#include "hardware.h"
#include "target.h"

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
_Static_assert(MAX_JOINTS == sizeof CHANNELS / sizeof *CHANNELS, "a channel for each joint");

static volatile uint16_t staged[MAX_JOINTS];
static volatile uint8_t staged_on;

void pulses_begin(void)
{
    for (uint8_t i = 0; i < MACHINE.joint_count; i++)
        *CHANNELS[i].direction |= CHANNELS[i].pin;
    /* Mode 14 as timer 1, and in step with it: none has a pulse in progress at LATCH. */
    ICR4 = PERIOD_COUNTS - 1;
    ICR5 = PERIOD_COUNTS - 1;
    TCCR4A = _BV(WGM41);
    TCCR5A = _BV(WGM51);
    TCCR4B = _BV(WGM43) | _BV(WGM42) | _BV(CS41);
    TCCR5B = _BV(WGM53) | _BV(WGM52) | _BV(CS51);
    TCNT4 = TCNT1;
    TCNT5 = TCNT1;
}

/* A compare value of n makes a pulse of n + 1 counts. */
bool hardware_stage_pulses(const uint16_t counts[MAX_JOINTS], uint32_t is_on, uint32_t periods)
{
    bool is_in_time;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
        is_in_time = hardware_periods() == periods;
        if (is_in_time) {
            for (uint8_t i = 0; i < MACHINE.joint_count; i++)
                staged[i] = counts[i] - 1;
            staged_on = (uint8_t)is_on;
        }
    }
    return is_in_time;
}

/* The chip has no encoders. */
bool hardware_read_positions(uint16_t counts[MAX_JOINTS])
{
    (void)counts;
    return false;
}

static void latch(void)
{
    uint8_t on = staged_on;
    for (uint8_t i = 0; i < MACHINE.joint_count; i++, on >>= 1) {
        const Channel *channel = &CHANNELS[i];
        *channel->width = staged[i];
        if (on & 1)
            *channel->control |= channel->connect;
        else
            *channel->control &= (uint8_t)~channel->connect;
    }
}

ISR(TIMER1_COMPC_vect)
{
    latch();
    chip_clock_begin_period();
}
