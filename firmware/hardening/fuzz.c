/* Plays anything to a board, for libFuzzer: `make fuzz`. An input is a list of acts.
 *
 * Frames get their CRC here, so that what is found out about bytes leads on to the commands. After
 * each act no pulse may be out of range, and no servo outrun.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "clock.h"
#include "host.h"
#include "parameters.h"
#include "wire.h"

/* The rest of an input. */
typedef struct {
    const uint8_t *bytes;
    size_t left;
} Input;

static Wires wires = {.machine = MACHINE_PARAMETERS};
static const uint16_t TABLE[3][MAX_JOINTS] = {{3000, 3000, 3000, 3000, 3000, 3000, 0, 0}};
static uint16_t before[MAX_JOINTS];

static uint8_t next_byte(Input *input)
{
    if (!input->left)
        return 0;
    input->left--;
    return *input->bytes++;
}

/* The next bytes, at most so many; how many there are. */
static uint8_t next_bytes(Input *input, uint8_t count, const uint8_t **bytes)
{
    uint8_t length = (uint8_t)(input->left < count ? input->left : count);
    *bytes = input->bytes;
    input->bytes += length;
    input->left -= length;
    return length;
}

static void check(bool is_so)
{
    if (!is_so)
        abort();
}

/* What goes out after at most one more period. */
static void check_pulses(void)
{
    const Machine *machine = &wires.machine;
    check(wires.mode <= MODE_PLAYING);
    for (uint8_t i = 0; i < machine->joint_count; i++) {
        uint16_t now = wires.pulses[i];
        check(!now || (now >= machine->lowest_counts[i] && now <= machine->highest_counts[i]));
        if (now && before[i])
            check(fabsf((float)now - (float)before[i]) <= machine->step_counts[i] + 1);
        before[i] = now;
    }
}

/* One period at a time: a release between two arms shows. */
static void pass(Host *host, uint8_t periods)
{
    while (periods--) {
        host_run(host, PERIOD_US);
        check_pulses();
    }
}

/* What a frame becomes on the wire is read back as the same. */
static void send_frame(Host *host, Input *input, uint16_t *sequence)
{
    Frame frame = {.type = next_byte(input) & 0x8F};
    Frame back = {0};
    const uint8_t *payload;
    *sequence = (uint16_t)(*sequence + 1);
    frame.sequence = *sequence;
    frame.length = next_bytes(input, next_byte(input) % (MAX_PAYLOAD + 1), &payload);
    memcpy(frame.payload, payload, frame.length);
    uint8_t wire[MAX_WIRE];
    uint8_t length = wire_encode(&frame, wire);
    check(wire_decode(wire, (uint8_t)(length - 1), &back));
    check(back.type == frame.type && back.length == frame.length);
    check(!memcmp(back.payload, frame.payload, frame.length));
    host_feed(host, wire, length);
}

/* On exactly as many bytes as there are, so that a byte beyond them is noticed. */
static void decode(Input *input)
{
    const uint8_t *bytes;
    Frame frame;
    uint8_t length = next_bytes(input, next_byte(input) % (MAX_STUFFED + 1), &bytes);
    uint8_t *exact = malloc(length ? length : 1);
    if (!exact)
        return;
    memcpy(exact, bytes, length);
    if (wire_decode(exact, length, &frame))
        check(frame.length <= MAX_PAYLOAD);
    free(exact);
}

static void receive(Host *host, Input *input, bool is_busy)
{
    const uint8_t *bytes;
    uint8_t length = next_bytes(input, next_byte(input), &bytes);
    if (is_busy)
        host_receive(host, bytes, length);
    else
        host_feed(host, bytes, length);
}

static void restart(Host *host, uint8_t cause)
{
    host_reset(host, cause);
    memset(before, 0, sizeof before);
}

static void act(Host *host, Input *input, uint16_t *sequence)
{
    uint8_t what = next_byte(input);
    switch (what >> 4) {
    case 0:
        wires.battery_mv = (uint16_t)(next_byte(input) << 6);
        break;
    case 1:
        wires.is_stop_open = what & 1;
        wires.is_start_closed = what & 2;
        break;
    case 2:
        wires.has_encoders = what & 1;
        break;
    case 3:
        restart(host, what);
        break;
    case 4:
        decode(input);
        break;
    case 5:
        *sequence = (uint16_t)(*sequence + (next_byte(input) << 8));
        break;
    case 6:
        receive(host, input, true);
        break;
    case 7:
        receive(host, input, false);
        break;
    case 8:
        pass(host, next_byte(input));
        break;
    case 9:
        wires.table = (FlashTable){.rows = what & 3, .step_ms = next_byte(input), .can_loop = true};
        break;
    default:
        send_frame(host, input, sequence);
    }
    pass(host, what & 1);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static uint8_t output[1024];
    Input input = {data, size};
    uint16_t sequence = 0;
    wires = (Wires){.machine = MACHINE_PARAMETERS, .battery_mv = 7600, .table_counts = TABLE[0]};
    wires.machine.arm_interval_ms = PERIOD_MS; /* so that short inputs come to play programs */
    Host *host = host_new(&wires);
    if (!host)
        return 0;
    restart(host, 1);
    while (input.left) {
        act(host, &input, &sequence);
        host_take(host, output, sizeof output);
    }
    host_free(host);
    return 0;
}
