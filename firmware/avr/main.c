/* Start: everything in its safe state, then the watchdog, then interrupts. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>

#include "board.h"
#include "chip_clock.h"
#include "hardware.h"
#include "inputs.h"
#include "link.h"
#include "pulses.h"
#include "uart.h"

static uint8_t reset_cause __attribute__((section(".noinit")));

/* Before anything else: after a watchdog reset the watchdog still runs, at its shortest time. */
__attribute__((naked, used, section(".init3"))) static void catch_reset(void)
{
    reset_cause = MCUSR;
    MCUSR = 0;
    wdt_disable();
}

void hardware_feed_watchdog(void)
{
    wdt_reset();
}

/* Rests until the next interrupt, unless there is work. The tick ends it within 1 ms. */
static void rest(void)
{
    cli();
    if (link_is_idle()) {
        sleep_enable();
        sei(); /* takes effect after the next instruction: no interrupt slips in between */
        sleep_cpu();
        sleep_disable();
    }
    sei();
}

int main(void)
{
    inputs_begin();
    uart_begin();
    chip_clock_begin();
    pulses_begin();
    board_begin(reset_cause);
    SMCR = 0; /* sleep is idle: the timers go on */
    wdt_enable(WDTO_250MS);
    sei();
    for (;;) {
        board_step();
        rest();
    }
}
