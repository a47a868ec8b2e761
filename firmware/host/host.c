#include "host.h"

#include <stdlib.h>
#include <string.h>

#include "board.h"
#include "clock.h"
#include "link.h"
#include "safety.h"
#include "target.h"

enum { OUTPUT_BYTES = 1024, TICK_US = 1000 };

struct Host {
    Wires *wires;
    uint64_t now_us;
    uint64_t next_latch_us;
    uint32_t periods;
    uint16_t staged[MAX_JOINTS];
    uint32_t staged_on;
    uint8_t output[OUTPUT_BYTES];
    uint32_t output_length;
    uint8_t state[]; /* the program's variables, while another board uses them */
};

const Machine *host_machine;

/* Where the program's variables begin and end: the linker makes these names for the section. */
extern uint8_t __start_board_state[] __attribute__((visibility("hidden")));
extern uint8_t __stop_board_state[] __attribute__((visibility("hidden")));

static Host *current;     /* whose turn it is */
static uint8_t *switched_on; /* the variables as a reset finds them */

static size_t state_size(void)
{
    return (size_t)((uintptr_t)__stop_board_state - (uintptr_t)__start_board_state);
}

/* Byte by byte: the address sanitizer keeps zones between the variables, which belong to none. */
__attribute__((no_sanitize("address"))) static void copy_state(uint8_t *to, const uint8_t *from)
{
    for (size_t i = 0; i < state_size(); i++)
        to[i] = from[i];
}

static void take_turn(Host *host)
{
    if (current == host)
        return;
    if (current)
        copy_state(current->state, __start_board_state);
    copy_state(__start_board_state, host->state);
    current = host;
    host_machine = &host->wires->machine;
}

uint32_t host_size_of_wires(void)
{
    return sizeof(Wires);
}

Host *host_new(Wires *wires)
{
    if (!switched_on) {
        switched_on = malloc(state_size());
        if (!switched_on)
            return NULL;
        copy_state(switched_on, __start_board_state);
    }
    Host *host = calloc(1, sizeof *host + state_size());
    if (!host)
        return NULL;
    host->wires = wires;
    host_reset(host, 1);
    return host;
}

void host_free(Host *host)
{
    if (current == host)
        current = NULL;
    free(host);
}

void host_reset(Host *host, uint8_t cause)
{
    Wires *wires = host->wires;
    memset(host, 0, sizeof *host);
    host->wires = wires;
    memset(wires->pulses, 0, sizeof wires->pulses);
    copy_state(host->state, switched_on);
    if (current == host)
        current = NULL;
    take_turn(host);
    board_begin(cause);
    wires->mode = safety_mode();
}

static void latch(Host *host)
{
    for (uint8_t i = 0; i < MACHINE.joint_count; i++)
        host->wires->pulses[i] = host->staged_on >> i & 1 ? host->staged[i] : 0;
    host->periods++;
    host->next_latch_us += PERIOD_US;
}

/* As the chip's loop: until there is nothing more to read. */
static void run_loop(Host *host)
{
    do
        board_step();
    while (!link_is_idle());
    host->wires->mode = safety_mode();
}

uint32_t host_run(Host *host, uint32_t us)
{
    take_turn(host);
    uint64_t end = host->now_us + us;
    for (;;) {
        if (host->next_latch_us <= host->now_us)
            latch(host);
        run_loop(host);
        if (host->now_us == end)
            return (uint32_t)(host->next_latch_us - end);
        uint64_t tick = (host->now_us / TICK_US + 1) * TICK_US;
        host->now_us = tick < end ? tick : end;
    }
}

void host_receive(Host *host, const uint8_t *bytes, uint32_t length)
{
    take_turn(host);
    for (uint32_t i = 0; i < length; i++)
        link_take_byte(bytes[i], false);
}

void host_feed(Host *host, const uint8_t *bytes, uint32_t length)
{
    take_turn(host);
    for (uint32_t i = 0; i < length; i++) {
        link_take_byte(bytes[i], false);
        run_loop(host);
    }
}

uint32_t host_take(Host *host, uint8_t *bytes, uint32_t room)
{
    uint32_t length = host->output_length < room ? host->output_length : room;
    memcpy(bytes, host->output, length);
    host->output_length -= length;
    memmove(host->output, host->output + length, host->output_length);
    return length;
}

/* The hardware that the program asks for: hardware.h. */

uint32_t hardware_periods(void)
{
    return current->periods;
}

/* The first period begins at time 0. */
uint32_t hardware_us(void)
{
    return (uint32_t)current->now_us;
}

bool hardware_stage_pulses(const uint16_t counts[MAX_JOINTS], uint32_t is_on, uint32_t periods)
{
    if (current->periods != periods)
        return false;
    memcpy(current->staged, counts, sizeof current->staged);
    current->staged_on = is_on;
    return true;
}

bool hardware_read_positions(uint16_t counts[MAX_JOINTS])
{
    memcpy(counts, current->wires->positions, sizeof current->wires->positions);
    return current->wires->has_encoders;
}

/* The line takes all at once. */
void hardware_start_sending(void)
{
    uint8_t byte;
    while (link_next_byte(&byte))
        if (current->output_length < OUTPUT_BYTES)
            current->output[current->output_length++] = byte;
}

bool hardware_is_stop_open(void)
{
    return current->wires->is_stop_open;
}

bool hardware_is_start_closed(void)
{
    return current->wires->is_start_closed;
}

uint16_t hardware_battery_mv(void)
{
    return current->wires->battery_mv;
}

bool hardware_is_memory_ready(void)
{
    return true;
}

uint8_t hardware_read_memory(uint16_t address)
{
    return current->wires->memory[address];
}

void hardware_write_memory(uint16_t address, uint8_t value)
{
    current->wires->memory[address] = value;
}

FlashTable hardware_flash_table(void)
{
    return current->wires->table;
}

uint16_t hardware_flash_count(uint16_t row, uint8_t joint)
{
    return current->wires->table_counts[(uint32_t)row * MACHINE.joint_count + joint];
}

/* Nothing hangs here. */
void hardware_feed_watchdog(void)
{
}
