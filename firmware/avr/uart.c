#include "uart.h"

#include <avr/interrupt.h>
#include <avr/io.h>

#include "hardware.h"
#include "link.h"
#include "target.h"

void uart_begin(void)
{
    UCSR0A = _BV(U2X0);
    /* The nearest; `hexarm firmware-header` refuses rates that are not near enough. */
    UBRR0 = (uint16_t)((F_CPU / 8 + MACHINE.baud / 2) / MACHINE.baud - 1);
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = _BV(RXEN0) | _BV(TXEN0) | _BV(RXCIE0);
}

void hardware_start_sending(void)
{
    UCSR0B |= _BV(UDRIE0);
}

ISR(USART0_RX_vect)
{
    bool is_after_loss = UCSR0A & _BV(DOR0);
    link_take_byte(UDR0, is_after_loss);
}

ISR(USART0_UDRE_vect)
{
    uint8_t byte;
    if (link_next_byte(&byte))
        UDR0 = byte;
    else
        UCSR0B &= (uint8_t)~_BV(UDRIE0);
}
