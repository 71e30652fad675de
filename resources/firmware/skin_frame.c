#include "skin_frame.h"

#include <string.h>

/* A nibble at a time: 64 bytes of table, where a byte at a time needs 1024. */
uint32_t skin_crc32(const uint8_t* bytes, size_t count) {
    static const uint32_t table[16] = {0x00000000, 0x1DB71064, 0x3B6E20C8, 0x26D930AC, 0x76DC4190, 0x6B6B51F4,
                                       0x4DB26158, 0x5005713C, 0xEDB88320, 0xF00F9344, 0xD6D6A3E8, 0xCB61B38C,
                                       0x9B64C2B0, 0x86D3D2D4, 0xA00AE278, 0xBDBDF21C};
    uint32_t crc = 0xFFFFFFFFu;
    for (size_t i = 0; i < count; ++i) {
        crc ^= bytes[i];
        crc = (crc >> 4) ^ table[crc & 15];
        crc = (crc >> 4) ^ table[crc & 15];
    }
    return ~crc;
}

static void put16(uint8_t* to, uint16_t value) {
    to[0] = (uint8_t)value;
    to[1] = (uint8_t)(value >> 8);
}

static void put32(uint8_t* to, uint32_t value) {
    put16(to, (uint16_t)value);
    put16(to + 2, (uint16_t)(value >> 16));
}

static uint16_t get16(const uint8_t* from) {
    return (uint16_t)(from[0] | from[1] << 8);
}

static uint32_t get32(const uint8_t* from) {
    return get16(from) | (uint32_t)get16(from + 2) << 16;
}

size_t skin_frame_encode(const skin_header* header, const uint8_t* payload, size_t length,
                         uint8_t encoded[SKIN_MAX_ENCODED]) {
    if (length > SKIN_MAX_PAYLOAD)
        return 0;
    uint8_t raw[SKIN_HEADER + SKIN_MAX_PAYLOAD + 4];
    raw[0] = header->version;
    raw[1] = header->incompatible;
    raw[2] = header->compatible;
    raw[3] = header->type;
    put16(raw + 4, header->sequence);
    raw[6] = header->epoch;
    raw[7] = header->direction;
    put16(raw + 8, header->first);
    put16(raw + 10, header->count);
    put32(raw + 12, header->time_us);
    if (length > 0)
        memcpy(raw + SKIN_HEADER, payload, length);
    size_t total = SKIN_HEADER + length;
    put32(raw + total, skin_crc32(raw, total));
    total += 4;

    /* Each block is led by the distance to the next zero. A frame is at most 254 bytes: no block is ever cut. */
    size_t lead = 0;
    size_t out = 1;
    for (size_t i = 0; i < total; ++i) {
        if (raw[i] != 0) {
            encoded[out++] = raw[i];
        } else {
            encoded[lead] = (uint8_t)(out - lead);
            lead = out++;
        }
    }
    encoded[lead] = (uint8_t)(out - lead);
    encoded[out++] = 0;
    return out;
}

/* In place, as it only ever gets shorter. Returns the length, 0 where a block points beyond the end. */
static size_t unstuff(uint8_t* bytes, size_t count) {
    size_t in = 0;
    size_t out = 0;
    while (in < count) {
        const size_t block = bytes[in++];
        if (block == 0 || in + block - 1 > count)
            return 0;
        for (size_t i = 1; i < block; ++i)
            bytes[out++] = bytes[in++];
        if (in < count && block < 255)
            bytes[out++] = 0;
    }
    return out;
}

bool skin_frame_push(skin_receiver* receiver, uint8_t byte, skin_header* header, const uint8_t** payload,
                     size_t* length) {
    if (byte != 0) {
        if (receiver->count < SKIN_MAX_ENCODED - 1)
            receiver->bytes[receiver->count++] = byte;
        else
            receiver->too_long = true;
        return false;
    }
    const size_t count = unstuff(receiver->bytes, receiver->count);
    const bool whole = !receiver->too_long && count >= SKIN_HEADER + 4 &&
                       get32(receiver->bytes + count - 4) == skin_crc32(receiver->bytes, count - 4);
    receiver->count = 0;
    receiver->too_long = false;
    if (!whole)
        return false;
    const uint8_t* raw = receiver->bytes;
    header->version = raw[0];
    header->incompatible = raw[1];
    header->compatible = raw[2];
    header->type = raw[3];
    header->sequence = get16(raw + 4);
    header->epoch = raw[6];
    header->direction = raw[7];
    header->first = get16(raw + 8);
    header->count = get16(raw + 10);
    header->time_us = get32(raw + 12);
    *payload = raw + SKIN_HEADER;
    *length = count - SKIN_HEADER - 4;
    return true;
}
