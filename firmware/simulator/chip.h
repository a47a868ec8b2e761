/* A simulated ATmega2560 with the board's wires, on libsimavr. Times are clock cycles, 16 MHz. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct Chip Chip;

typedef struct {
    uint64_t cycle;
    uint8_t channel;
    uint8_t level;
} Edge;

/* A chip that holds a program, held in reset; null where the file cannot be read. */
Chip *chip_new(const char *elf_path, uint32_t baud);
void chip_free(Chip *chip);

/* Starts again, with these bits in MCUSR. The line and the log of edges are empty then. */
void chip_reset(Chip *chip, uint8_t cause);

/* Runs until that cycle; false when the chip has crashed. */
bool chip_run(Chip *chip, uint64_t cycle);
uint64_t chip_cycle(const Chip *chip);

/* How often the watchdog has reset it. */
uint32_t chip_watchdog_resets(const Chip *chip);

/* Bytes for the chip, sent at the line's rate from now on; how many still wait. */
void chip_feed(Chip *chip, const uint8_t *bytes, uint32_t length);
uint32_t chip_backlog(const Chip *chip);

/* Bytes that the chip has sent since the last call; how many. */
uint32_t chip_take(Chip *chip, uint8_t *bytes, uint32_t room);

/* Bytes that a real chip, which buffers two, would have lost. */
uint32_t chip_lost_bytes(const Chip *chip);

/* The edges of the servo pins since the last call, and as channel 255 the moments that the program
 * marked by writing to GPIOR0; how many. */
uint32_t chip_edges(Chip *chip, Edge *edges, uint32_t room);

/* The voltage at A0, and what is switched to ground: pin 0 stop button, pin 1 start button. */
void chip_set_battery_pin(Chip *chip, uint32_t millivolts);
void chip_set_button(Chip *chip, uint8_t pin, bool is_open);

/* The program is caught in an endless loop, as if it were hung; interrupts go on or not. */
void chip_hang(Chip *chip, bool with_interrupts);

/* One byte of the chip's memory. */
uint8_t chip_peek(const Chip *chip, uint16_t address);
void chip_poke(Chip *chip, uint16_t address, uint8_t value);
