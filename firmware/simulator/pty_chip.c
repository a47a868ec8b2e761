/* The simulated board in real time, its serial line on a pty: pty_chip PROGRAM BAUD LINK BATTERY_MV
 *
 * LINK becomes a symbolic link to the pty and goes away again at the end, on SIGTERM or SIGINT.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <pty.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "chip.h"

enum { CYCLES_A_MS = 16000, TICK_NS = 1000000, MOST_BEHIND_MS = 100, DIVIDER = 2 };

static volatile sig_atomic_t is_ending;

static void end(int number)
{
    (void)number;
    is_ending = 1;
}

static int open_pty(const char *link)
{
    int board_end, host_end;
    char name[64];
    struct termios raw = {0};
    cfmakeraw(&raw);
    /* The host's end stays open here too, so that reading never fails while no host is there. */
    if (openpty(&board_end, &host_end, name, &raw, NULL) || symlink(name, link))
        return -1;
    fcntl(board_end, F_SETFL, O_NONBLOCK);
    return board_end;
}

static uint64_t now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000 + (uint64_t)now.tv_nsec / 1000000;
}

/* What does not fit, because nobody reads, is lost as on a real line. */
static void exchange(Chip *chip, int line)
{
    uint8_t bytes[4096];
    ssize_t length = read(line, bytes, sizeof bytes);
    if (length > 0)
        chip_feed(chip, bytes, (uint32_t)length);
    uint32_t sent = chip_take(chip, bytes, sizeof bytes);
    if (sent && write(line, bytes, sent) < 0 && errno != EAGAIN)
        is_ending = 1;
}

static bool run(Chip *chip, int line)
{
    uint64_t start = now_ms();
    while (!is_ending) {
        uint64_t ms = now_ms() - start;
        uint64_t there = chip_cycle(chip) / CYCLES_A_MS;
        if (ms > there + MOST_BEHIND_MS) /* what was missed is not made up for */
            start += ms - there - 1;
        if (!chip_run(chip, ms * CYCLES_A_MS))
            return false;
        exchange(chip, line);
        nanosleep(&(struct timespec){0, TICK_NS}, NULL);
    }
    return true;
}

int main(int count, char **words)
{
    if (count != 5) {
        fputs("pty_chip PROGRAM BAUD LINK BATTERY_MV\n", stderr);
        return 2;
    }
    const char *link = words[3];
    Chip *chip = chip_new(words[1], (uint32_t)atol(words[2]));
    if (!chip) {
        fprintf(stderr, "pty_chip: %s is no program\n", words[1]);
        return 1;
    }
    chip_set_battery_pin(chip, (uint32_t)atol(words[4]) / DIVIDER);
    int line = open_pty(link);
    if (line < 0) {
        fprintf(stderr, "pty_chip: %s: %s\n", link, strerror(errno));
        return 1;
    }
    signal(SIGTERM, end);
    signal(SIGINT, end);
    bool is_well = run(chip, line);
    unlink(link);
    if (!is_well)
        fputs("pty_chip: the program has crashed\n", stderr);
    chip_free(chip);
    return !is_well;
}
