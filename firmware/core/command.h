/* The host's commands: what is in a frame, and who does it. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "protocol.h"
#include "wire.h"

/* The counts in a payload, as values; their number, or 0 where they are none. */
uint8_t command_counts(const uint8_t *payload, uint8_t length, uint16_t counts[MAX_JOINTS]);

/* The payload has the length that its type needs. */
bool command_is_well_formed(const Frame *frame);

/* Does what a well-formed command asks for, or refuses with a reason: enum Result. */
uint8_t command_obey(const Frame *frame);
