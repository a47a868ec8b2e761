#include "chip.h"

#include <avr_adc.h>
#include <avr_ioport.h>
#include <avr_timer.h>
#include <avr_uart.h>
#include <sim_avr.h>
#include <sim_elf.h>
#include <sim_irq.h>
#include <stdlib.h>
#include <string.h>

enum {
    CLOCK_HZ = 16000000,
    BITS_A_BYTE = 10,
    CHANNELS = 8,
    LOG = 1 << 18,
    MCUSR_ADDRESS = 0x54,
    GPIOR0_ADDRESS = 0x3E,
    MARKS = 255,
    WDRF_BIT = 3,
    REAL_BUFFER = 2,
    /* libsimavr counts a parity bit that is not there, and a byte's time only from when the one
     * before was read, so that lateness would add up for ever. The line's own rate is kept here:
     * let the UART be a little faster. */
    UART_PACE = 90,
    HANG_ADDRESS = 0x3F000,
    RELATIVE_JUMP_TO_ITSELF = 0xCFFF,
};

struct Chip {
    avr_t *avr;
    avr_uart_t *uart;
    uint64_t cycles_a_byte;
    uint8_t *to_chip;
    uint32_t to_chip_start, to_chip_end;
    uint8_t *from_chip;
    uint32_t from_chip_length;
    Edge *edges;
    uint32_t edge_count;
    uint8_t level[CHANNELS];
    uint32_t lost_bytes, watchdog_resets;
    uint32_t battery_pin_mv;
    bool is_open[2];
    bool is_line_busy;
};

/* The pins of servo.c's channels. */
static const struct {
    char port;
    uint8_t bit;
} PINS[CHANNELS] = {{'H', 3}, {'H', 4}, {'H', 5}, {'L', 3}, {'L', 4}, {'L', 5}, {'B', 5}, {'B', 6}};

static void quiet(avr_t *avr, const int level, const char *format, va_list arguments)
{
    (void)avr;
    (void)level;
    (void)format;
    (void)arguments;
}

/* Sleep takes no time of ours. */
static void sleep_not(avr_t *avr, avr_cycle_count_t cycles)
{
    (void)avr;
    (void)cycles;
}

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

static void on_pin(Chip *chip, uint8_t channel, uint8_t level)
{
    if (level == chip->level[channel])
        return;
    chip->level[channel] = level;
    if (chip->edge_count < LOG)
        chip->edges[chip->edge_count++] = (Edge){chip->avr->cycle, channel, level};
}

static Chip *the_chip; /* libsimavr's callbacks carry one pointer; the channel is that one */

static void on_servo_pin(avr_irq_t *irq, uint32_t value, void *param)
{
    (void)irq;
    on_pin(the_chip, (uint8_t)(uintptr_t)param, value & 1);
}

/* A program marks a moment by writing to GPIOR0: an edge of channel MARKS. */
static void on_mark(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    Chip *chip = param;
    avr->data[address] = value;
    if (chip->edge_count < LOG)
        chip->edges[chip->edge_count++] = (Edge){avr->cycle, MARKS, value};
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

/* What a reset drops: flags and voltages; the cycle timers are gone as well. */
static void attach(Chip *chip)
{
    uint32_t flags = 0;
    avr_ioctl(chip->avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    chip->avr->run_cycle_limit = 1600;
    chip->to_chip_start = chip->to_chip_end = 0;
    chip->is_line_busy = false;
    chip_set_battery_pin(chip, chip->battery_pin_mv);
    for (uint8_t pin = 0; pin < 2; pin++)
        chip_set_button(chip, pin, chip->is_open[pin]);
}

Chip *chip_new(const char *elf_path, uint32_t baud)
{
    elf_firmware_t program = {0};
    avr_global_logger_set(quiet);
    if (elf_read_firmware(elf_path, &program))
        return NULL;
    strcpy(program.mmcu, "atmega2560");
    program.frequency = CLOCK_HZ;
    Chip *chip = calloc(1, sizeof *chip);
    chip->to_chip = malloc(LOG * 8);
    chip->from_chip = malloc(LOG);
    chip->edges = malloc(LOG * sizeof *chip->edges);
    chip->avr = avr_make_mcu_by_name(program.mmcu);
    avr_init(chip->avr);
    avr_load_firmware(chip->avr, &program);
    chip->avr->sleep = sleep_not;
    chip->avr->vcc = chip->avr->avcc = chip->avr->aref = 5000;
    chip->uart = find_uart(chip->avr);
    chip->cycles_a_byte = (uint64_t)CLOCK_HZ * BITS_A_BYTE / baud;
    chip->is_open[1] = true;
    avr_irq_register_notify(uart_irq(chip, UART_IRQ_OUTPUT), on_byte, chip);
    avr_register_io_write(chip->avr, GPIOR0_ADDRESS, on_mark, chip);
    for (uintptr_t channel = 0; channel < CHANNELS; channel++) {
        uint32_t port = AVR_IOCTL_IOPORT_GETIRQ(PINS[channel].port);
        avr_irq_t *irq = avr_io_getirq(chip->avr, port, PINS[channel].bit);
        avr_irq_register_notify(irq, on_servo_pin, (void *)channel);
    }
    uint8_t *hang = chip->avr->flash + HANG_ADDRESS;
    hang[0] = RELATIVE_JUMP_TO_ITSELF & 0xFF;
    hang[1] = RELATIVE_JUMP_TO_ITSELF >> 8;
    chip->avr->codeend = chip->avr->flashend;
    chip_reset(chip, 1);
    return chip;
}

void chip_free(Chip *chip)
{
    avr_terminate(chip->avr);
    free(chip->to_chip);
    free(chip->from_chip);
    free(chip->edges);
    free(chip);
}

void chip_reset(Chip *chip, uint8_t cause)
{
    the_chip = chip;
    avr_reset(chip->avr);
    chip->avr->data[MCUSR_ADDRESS] = cause;
    chip->from_chip_length = chip->edge_count = 0;
    memset(chip->level, 0, sizeof chip->level);
    attach(chip);
}

bool chip_run(Chip *chip, uint64_t cycle)
{
    avr_t *avr = chip->avr;
    the_chip = chip;
    while (avr->cycle < cycle) {
        avr_cycle_count_t left = cycle - avr->cycle;
        avr->run_cycle_limit = left < 1600 ? left : 1600;
        chip->uart->cycles_per_byte = chip->cycles_a_byte * UART_PACE / 100;
        avr_flashaddr_t before = avr->pc;
        int state = avr_run(avr);
        if (state == cpu_Done || state == cpu_Crashed)
            return false;
        bool is_reset = before != 0 && avr->pc == 0;
        if (is_reset && avr->data[MCUSR_ADDRESS] & 1 << WDRF_BIT) {
            chip->watchdog_resets++;
            attach(chip);
        }
    }
    return true;
}

uint64_t chip_cycle(const Chip *chip)
{
    return chip->avr->cycle;
}

uint32_t chip_watchdog_resets(const Chip *chip)
{
    return chip->watchdog_resets;
}

void chip_feed(Chip *chip, const uint8_t *bytes, uint32_t length)
{
    if (chip->to_chip_start == chip->to_chip_end)
        chip->to_chip_start = chip->to_chip_end = 0;
    if (length > LOG * 8 - chip->to_chip_end)
        length = LOG * 8 - chip->to_chip_end;
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

void chip_hang(Chip *chip, bool with_interrupts)
{
    chip->avr->pc = HANG_ADDRESS;
    chip->avr->state = cpu_Running;
    chip->avr->sreg[S_I] = with_interrupts;
}

uint8_t chip_peek(const Chip *chip, uint16_t address)
{
    return chip->avr->data[address];
}

void chip_poke(Chip *chip, uint16_t address, uint8_t value)
{
    chip->avr->data[address] = value;
}

uint16_t chip_stack_pointer(const Chip *chip)
{
    return (uint16_t)(chip->avr->data[R_SPL] | chip->avr->data[R_SPH] << 8);
}
