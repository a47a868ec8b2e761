#include "chip_clock.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/atomic.h>

#include "clock.h"

/* So that the first period begins at once, and no timer counts through a pulse before. */
#define FIRST_COUNT (LATCH - 20)
#define TIMER0_1KHZ (250 - 1)

static volatile uint32_t periods;

void chip_clock_begin(void)
{
    /* Mode 14: fast PWM up to ICR; prescaler 8. pulses.c connects the outputs A and B. */
    ICR1 = PERIOD_COUNTS - 1;
    OCR1C = LATCH;
    TCCR1A = _BV(WGM11);
    TCCR1B = _BV(WGM13) | _BV(WGM12) | _BV(CS11);
    TCNT1 = FIRST_COUNT;
    TIMSK1 = _BV(OCIE1C);

    /* A millisecond's tick only wakes the loop: deadlines pass between periods too. */
    OCR0A = TIMER0_1KHZ;
    TCCR0A = _BV(WGM01);
    TCCR0B = _BV(CS01) | _BV(CS00);
    TIMSK0 = _BV(OCIE0A);
}

EMPTY_INTERRUPT(TIMER0_COMPA_vect)

void chip_clock_begin_period(void)
{
    periods++;
}

uint32_t hardware_periods(void)
{
    uint32_t begun;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
        begun = periods;
    }
    return begun;
}

uint32_t hardware_us(void)
{
    uint32_t begun;
    uint16_t count;
    bool is_late;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
        count = TCNT1;
        is_late = TIFR1 & _BV(OCF1C);
        begun = periods;
    }
    /* Read before the latch, flagged after it: then `count` still belongs to the old period. */
    if (is_late && count >= LATCH)
        begun++;
    uint16_t since = count >= LATCH ? count - LATCH : count + (PERIOD_COUNTS - LATCH);
    return (begun - 1) * PERIOD_US + since / 2;
}
