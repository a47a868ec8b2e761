#include "wire.h"

#include <string.h>

/* As avr-libc's _crc_xmodem_update, in portable C (Perez, "Byte-wise CRC calculations", 1983). */
uint16_t wire_crc(uint16_t crc, uint8_t byte)
{
    uint8_t mixed = (uint8_t)(crc >> 8 ^ byte);
    mixed = (uint8_t)(mixed ^ mixed >> 4);
    return (uint16_t)((uint16_t)(crc << 8) ^ (uint16_t)((uint16_t)mixed << 12) ^
                      (uint16_t)((uint16_t)mixed << 5) ^ mixed);
}

static uint16_t checksum(const uint8_t *content, uint8_t length)
{
    uint16_t crc = 0xFFFF;
    while (length--)
        crc = wire_crc(crc, *content++);
    return crc;
}

uint8_t wire_encode(const Frame *frame, uint8_t *wire)
{
    uint8_t content[MAX_STUFFED];
    content[0] = frame->type;
    put16(content + 1, frame->sequence);
    memcpy(content + HEAD, frame->payload, frame->length);
    uint8_t length = (uint8_t)(HEAD + frame->length);
    put16(content + length, checksum(content, length));
    length = (uint8_t)(length + CRC);

    /* COBS: each zero gives way to the distance to the next one. */
    uint8_t code = 0;
    uint8_t out = 1;
    for (uint8_t i = 0; i < length; i++) {
        if (content[i]) {
            wire[out++] = content[i];
        } else {
            wire[code] = (uint8_t)(out - code);
            code = out++;
        }
    }
    wire[code] = (uint8_t)(out - code);
    wire[out++] = 0;
    return out;
}

bool wire_decode(const uint8_t *stuffed, uint8_t length, Frame *frame)
{
    uint8_t content[MAX_STUFFED];
    uint8_t size = 0;
    for (uint8_t at = 0; at < length;) {
        uint8_t code = stuffed[at];
        if (code == 0 || code > length - at)
            return false;
        memcpy(content + size, stuffed + at + 1, (size_t)(code - 1));
        size = (uint8_t)(size + code - 1);
        at = (uint8_t)(at + code);
        if (at < length)
            content[size++] = 0;
    }
    if (size < HEAD + CRC || size - HEAD - CRC > MAX_PAYLOAD)
        return false;
    size = (uint8_t)(size - CRC);
    if (checksum(content, size) != get16(content + size))
        return false;
    frame->type = content[0];
    frame->sequence = get16(content + 1);
    frame->length = (uint8_t)(size - HEAD);
    memcpy(frame->payload, content + HEAD, frame->length);
    return true;
}
