/* The pins of the simulated chip: servo pulses edge by edge, buttons, battery. */
#include <avr_adc.h>
#include <avr_ioport.h>
#include <sim_irq.h>
#include <stdlib.h>
#include <string.h>

#include "chip_parts.h"

enum { GPIOR0_ADDRESS = 0x3E, MARKS = 255 };

/* The channels of pulses.c: their pins, and the low bytes of their compare registers. */
static const struct {
    char port;
    uint8_t bit;
    uint16_t compare;
} PINS[CHANNELS] = {
    {'H', 3, 0xA8}, {'H', 4, 0xAA}, {'H', 5, 0xAC}, /* OCR4A to C */
    {'L', 3, 0x128}, {'L', 4, 0x12A}, {'L', 5, 0x12C}, /* OCR5A to C */
    {'B', 5, 0x88}, {'B', 6, 0x8A}, /* OCR1A, B */
};

static void on_pin(Chip *chip, uint8_t channel, uint8_t level)
{
    if (level == chip->level[channel])
        return;
    chip->level[channel] = level;
    if (chip->edge_count < LOG)
        chip->edges[chip->edge_count++] = (Edge){chip->avr->cycle, channel, level};
}

static void on_servo_pin(avr_irq_t *irq, uint32_t value, void *param)
{
    (void)irq;
    const Tap *tap = param;
    on_pin(tap->chip, tap->channel, value & 1);
}

/* A program marks a moment by writing to GPIOR0: an edge of channel MARKS. */
static void on_mark(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    Chip *chip = param;
    avr->data[address] = value;
    if (chip->edge_count < LOG)
        chip->edges[chip->edge_count++] = (Edge){avr->cycle, MARKS, value};
}

/* libsimavr takes a compare value for no news where only its high byte has changed: let the low one
 * change as well, and change back. */
static void on_compare(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    const Compare *compare = param;
    compare->write(avr, address, value ^ 1, compare->param);
    compare->write(avr, address, value, compare->param);
}

static void watch_compare(Chip *chip, uint8_t channel)
{
    Compare *compare = &chip->compares[channel];
    uint16_t io = AVR_DATA_TO_IO(PINS[channel].compare);
    *compare = (Compare){chip->avr->io[io].w.c, chip->avr->io[io].w.param};
    chip->avr->io[io].w.c = on_compare;
    chip->avr->io[io].w.param = compare;
}

void pins_connect(Chip *chip)
{
    chip->edges = malloc(LOG * sizeof *chip->edges);
    chip->is_open[1] = true;
    avr_register_io_write(chip->avr, GPIOR0_ADDRESS, on_mark, chip);
    for (uint8_t channel = 0; channel < CHANNELS; channel++) {
        uint32_t port = AVR_IOCTL_IOPORT_GETIRQ(PINS[channel].port);
        avr_irq_t *irq = avr_io_getirq(chip->avr, port, PINS[channel].bit);
        chip->taps[channel] = (Tap){chip, channel};
        avr_irq_register_notify(irq, on_servo_pin, &chip->taps[channel]);
        watch_compare(chip, channel);
    }
}

void pins_reset(Chip *chip)
{
    chip_set_battery_pin(chip, chip->battery_pin_mv);
    for (uint8_t pin = 0; pin < 2; pin++)
        chip_set_button(chip, pin, chip->is_open[pin]);
}

uint32_t chip_edges(Chip *chip, Edge *edges, uint32_t room)
{
    uint32_t count = chip->edge_count < room ? chip->edge_count : room;
    memcpy(edges, chip->edges, count * sizeof *edges);
    memmove(chip->edges, chip->edges + count, (chip->edge_count - count) * sizeof *edges);
    chip->edge_count -= count;
    return count;
}

void chip_set_battery_pin(Chip *chip, uint32_t millivolts)
{
    chip->battery_pin_mv = millivolts;
    avr_raise_irq(avr_io_getirq(chip->avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0), millivolts);
}

void chip_set_button(Chip *chip, uint8_t pin, bool is_open)
{
    chip->is_open[pin] = is_open;
    avr_ioport_external_t external = {.name = 'A', .mask = 3};
    for (uint8_t i = 0; i < 2; i++)
        external.value |= (unsigned)chip->is_open[i] << i;
    avr_ioctl(chip->avr, AVR_IOCTL_IOPORT_SET_EXTERNAL('A'), &external);
    /* There and back: a reset clears the pin, but a value that is no news is not passed on. */
    avr_irq_t *irq = avr_io_getirq(chip->avr, AVR_IOCTL_IOPORT_GETIRQ('A'), pin);
    avr_raise_irq(irq, !is_open);
    avr_raise_irq(irq, is_open);
}
