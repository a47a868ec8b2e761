/* Frames to bytes on the wire and back. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* A frame on the wire has at most 63 bytes with its delimiter: 62 stuffed, 61 of content. */
enum { MAX_STUFFED = 62, MAX_WIRE = MAX_STUFFED + 1, HEAD = 3, CRC = 2 };
enum { MAX_PAYLOAD = MAX_STUFFED - 1 - HEAD - CRC };

typedef struct {
    uint8_t type;
    uint16_t sequence;
    uint8_t length; /* of the payload */
    uint8_t payload[MAX_PAYLOAD];
} Frame;

/* Fills `wire` (MAX_WIRE bytes) with the frame and its delimiter; how many bytes it took. */
uint8_t wire_encode(const Frame *frame, uint8_t *wire);

/* The frame in the bytes before a delimiter, at most MAX_STUFFED; false where they are damaged. */
bool wire_decode(const uint8_t *stuffed, uint8_t length, Frame *frame);

/* CRC-16, polynomial 0x1021, of one more byte; starts from 0xFFFF. */
uint16_t wire_crc(uint16_t crc, uint8_t byte);

static inline uint16_t get16(const uint8_t *at)
{
    return (uint16_t)(at[0] | at[1] << 8);
}

static inline uint8_t *put16(uint8_t *at, uint16_t value)
{
    at[0] = (uint8_t)value;
    at[1] = (uint8_t)(value >> 8);
    return at + 2;
}

static inline uint8_t *put32(uint8_t *at, uint32_t value)
{
    return put16(put16(at, (uint16_t)value), (uint16_t)(value >> 16));
}
