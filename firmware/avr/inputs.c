#include "inputs.h"

#include <avr/io.h>

#include "hardware.h"

/* 5 V at the pin are 10 V at the battery: more than two full Li-Ion cells. */
#define FULL_SCALE_MV 10000UL
#define STEPS 1024UL

enum { STOP_PIN = _BV(PA0), START_PIN = _BV(PA1) };

static uint16_t last_mv;

void inputs_begin(void)
{
    PORTA = STOP_PIN | START_PIN; /* the chip's own pull-ups */
    ADMUX = _BV(REFS0); /* against AVCC, which the converter keeps at 5 V; channel 0 */
    ADCSRA = _BV(ADEN) | _BV(ADPS2) | _BV(ADPS1) | _BV(ADPS0);
    DIDR0 = _BV(ADC0D);
    ADCSRA |= _BV(ADSC);
    while (ADCSRA & _BV(ADSC)) /* once, 0.2 ms: the first STATE reports what is there */
        continue;
}

uint16_t hardware_battery_mv(void)
{
    if (!(ADCSRA & _BV(ADSC))) {
        last_mv = (uint16_t)((2UL * ADC + 1) * FULL_SCALE_MV / (2 * STEPS)); /* middle of a step */
        ADCSRA |= _BV(ADSC);
    }
    return last_mv;
}

bool hardware_is_stop_open(void)
{
    return PINA & STOP_PIN;
}

bool hardware_is_start_closed(void)
{
    return !(PINA & START_PIN);
}
