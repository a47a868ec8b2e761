/* What the files of the simulated chip share. */
#pragma once
#include <avr_uart.h>
#include <sim_avr.h>

#include "chip.h"

enum { CLOCK_HZ = 16000000, CHANNELS = 8, LOG = 1 << 18 };

/* What a servo pin's callback receives: which pin of which chip. */
typedef struct {
    Chip *chip;
    uint8_t channel;
} Tap;

/* What libsimavr does when a compare register is written. */
typedef struct {
    avr_io_write_t write;
    void *param;
} Compare;

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
    Tap taps[CHANNELS];
    Compare compares[CHANNELS];
    uint8_t level[CHANNELS];
    uint32_t lost_bytes, watchdog_resets;
    uint32_t battery_pin_mv;
    bool is_open[2];
    bool is_line_busy;
};

/* Connects the serial line, and the pins, to a chip that was just made. */
void line_connect(Chip *chip, uint32_t baud);
void pins_connect(Chip *chip);

/* What a reset drops: flags and voltages; the cycle timers are gone as well. */
void line_reset(Chip *chip);
void pins_reset(Chip *chip);

/* Keeps the UART at the line's pace, whatever the program has set; call as often as it runs. */
void line_pace(Chip *chip);
