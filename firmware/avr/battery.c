#include "battery.h"

#include <avr/io.h>

/* 5 V at the pin are 10 V at the battery: more than two full Li-Ion cells. */
enum { FULL_SCALE_MV = 10000, STEPS = 1024 };

static uint16_t last_mv;

void battery_begin(void)
{
    ADMUX = _BV(REFS0); /* against AVCC, which the converter keeps at 5 V; channel 0 */
    ADCSRA = _BV(ADEN) | _BV(ADPS2) | _BV(ADPS1) | _BV(ADPS0);
    DIDR0 = _BV(ADC0D);
    ADCSRA |= _BV(ADSC);
    while (ADCSRA & _BV(ADSC)) /* once, 0.2 ms: the first STATE tells what is there */
        continue;
}

uint16_t battery_mv(void)
{
    if (!(ADCSRA & _BV(ADSC))) {
        last_mv = (uint16_t)((2UL * ADC + 1) * FULL_SCALE_MV / (2 * STEPS)); /* middle of a step */
        ADCSRA |= _BV(ADSC);
    }
    return last_mv;
}
