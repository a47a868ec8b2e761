/* The simulated chip itself: its program, its time, its resets, its memory. */
#include <sim_avr.h>
#include <sim_elf.h>
#include <stdlib.h>
#include <string.h>

#include "chip_parts.h"

enum {
    MCUSR_ADDRESS = 0x54,
    POWER_ON = 1,
    WDRF_BIT = 3,
    LONGEST_RUN = 1600, /* cycles that libsimavr may run before it looks at its timers */
    HANG_ADDRESS = 0x3F000,
    RELATIVE_JUMP_TO_ITSELF = 0xCFFF,
};

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

Chip *chip_new(const char *elf_path, uint32_t baud)
{
    elf_firmware_t program = {0};
    avr_global_logger_set(quiet);
    if (elf_read_firmware(elf_path, &program))
        return NULL;
    strcpy(program.mmcu, "atmega2560");
    program.frequency = CLOCK_HZ;
    Chip *chip = calloc(1, sizeof *chip);
    chip->avr = avr_make_mcu_by_name(program.mmcu);
    avr_init(chip->avr);
    avr_load_firmware(chip->avr, &program);
    chip->avr->sleep = sleep_not;
    chip->avr->vcc = chip->avr->avcc = chip->avr->aref = 5000;
    line_connect(chip, baud);
    pins_connect(chip);
    uint8_t *hang = chip->avr->flash + HANG_ADDRESS;
    hang[0] = RELATIVE_JUMP_TO_ITSELF & 0xFF;
    hang[1] = RELATIVE_JUMP_TO_ITSELF >> 8;
    chip->avr->codeend = chip->avr->flashend;
    chip_reset(chip, POWER_ON);
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
    avr_reset(chip->avr);
    chip->avr->data[MCUSR_ADDRESS] = cause;
    chip->from_chip_length = chip->edge_count = 0;
    memset(chip->level, 0, sizeof chip->level);
    line_reset(chip);
    pins_reset(chip);
}

bool chip_run(Chip *chip, uint64_t cycle)
{
    avr_t *avr = chip->avr;
    while (avr->cycle < cycle) {
        avr_cycle_count_t left = cycle - avr->cycle;
        avr->run_cycle_limit = left < LONGEST_RUN ? left : LONGEST_RUN;
        line_pace(chip);
        avr_flashaddr_t before = avr->pc;
        int state = avr_run(avr);
        if (state == cpu_Done || state == cpu_Crashed)
            return false;
        bool is_reset = before != 0 && avr->pc == 0;
        if (is_reset && avr->data[MCUSR_ADDRESS] & 1 << WDRF_BIT) {
            chip->watchdog_resets++;
            line_reset(chip);
            pins_reset(chip);
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
