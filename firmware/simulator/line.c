/* The serial line of the simulated chip: bytes in and out, at the line's rate. */
#include <avr_uart.h>
#include <sim_irq.h>
#include <stdlib.h>
#include <string.h>

#include "chip_parts.h"

enum {
    BITS_A_BYTE = 10,
    REAL_BUFFER = 2,
    TO_CHIP = 8 * LOG,
    /* libsimavr counts a parity bit that is not there, and a byte's time only from when the one
     * before was read, so that lateness would add up for ever. The line's own rate is kept here:
     * let the UART be a little faster. */
    UART_PACE = 90,
};

static avr_irq_t *uart_irq(Chip *chip, int which)
{
    return avr_io_getirq(chip->avr, AVR_IOCTL_UART_GETIRQ('0'), which);
}

static void on_byte(avr_irq_t *irq, uint32_t value, void *param)
{
    (void)irq;
    Chip *chip = param;
    if (chip->from_chip_length < LOG)
        chip->from_chip[chip->from_chip_length++] = (uint8_t)value;
}

static avr_cycle_count_t send_next(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)avr;
    Chip *chip = param;
    if (chip->to_chip_start == chip->to_chip_end) {
        chip->is_line_busy = false;
        return 0;
    }
    if (((chip->uart->input.write - chip->uart->input.read) & (uart_fifo_fifo_size - 1)) > REAL_BUFFER)
        chip->lost_bytes++;
    avr_raise_irq(uart_irq(chip, UART_IRQ_INPUT), chip->to_chip[chip->to_chip_start++]);
    return when + chip->cycles_a_byte;
}

static avr_uart_t *find_uart(avr_t *avr)
{
    for (avr_io_t *io = avr->io_port; io; io = io->next)
        if (!strcmp(io->kind, "uart") && ((avr_uart_t *)io)->name == '0')
            return (avr_uart_t *)io;
    return NULL;
}

void line_connect(Chip *chip, uint32_t baud)
{
    chip->uart = find_uart(chip->avr);
    chip->cycles_a_byte = (uint64_t)CLOCK_HZ * BITS_A_BYTE / baud;
    chip->to_chip = malloc(TO_CHIP);
    chip->from_chip = malloc(LOG);
    avr_irq_register_notify(uart_irq(chip, UART_IRQ_OUTPUT), on_byte, chip);
}

void line_reset(Chip *chip)
{
    uint32_t flags = 0; /* no copy on standard output, no sleep of ours while it polls */
    avr_ioctl(chip->avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    chip->to_chip_start = chip->to_chip_end = 0;
    chip->is_line_busy = false;
}

void line_pace(Chip *chip)
{
    chip->uart->cycles_per_byte = chip->cycles_a_byte * UART_PACE / 100;
}

void chip_feed(Chip *chip, const uint8_t *bytes, uint32_t length)
{
    if (chip->to_chip_start == chip->to_chip_end)
        chip->to_chip_start = chip->to_chip_end = 0;
    if (length > TO_CHIP - chip->to_chip_end)
        length = TO_CHIP - chip->to_chip_end;
    memcpy(chip->to_chip + chip->to_chip_end, bytes, length);
    chip->to_chip_end += length;
    if (length && !chip->is_line_busy) {
        chip->is_line_busy = true;
        avr_cycle_timer_register(chip->avr, chip->cycles_a_byte, send_next, chip);
    }
}

uint32_t chip_backlog(const Chip *chip)
{
    return chip->to_chip_end - chip->to_chip_start;
}

uint32_t chip_take(Chip *chip, uint8_t *bytes, uint32_t room)
{
    uint32_t length = chip->from_chip_length < room ? chip->from_chip_length : room;
    memcpy(bytes, chip->from_chip, length);
    memmove(chip->from_chip, chip->from_chip + length, chip->from_chip_length - length);
    chip->from_chip_length -= length;
    return length;
}

uint32_t chip_lost_bytes(const Chip *chip)
{
    return chip->lost_bytes;
}
