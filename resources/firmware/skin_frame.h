/* Frames of the skin protocol: a header and a payload with a CRC-32, stuffed so that zero bytes only end a frame.
 * Portable C99 without a heap. The bytes are described in the protocol's specification. */
#ifndef SKIN_FRAME_H
#define SKIN_FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    SKIN_VERSION = 1,
    SKIN_HEADER = 16,
    SKIN_MAX_PAYLOAD = 234,
    SKIN_EMPTY_FRAME = 22,  /* bytes of an encoded frame without a payload */
    SKIN_MAX_ENCODED = 256, /* with the zero at its end */
};

/* Bits of skin_header.compatible. */
enum {
    SKIN_RELIABLE = 1, /* to be acknowledged */
    SKIN_FIRST = 2,    /* the sender has not been acknowledged since it started: its numbers begin anew */
};

enum { SKIN_LOCAL = 0, SKIN_DOWN = 1, SKIN_UP = 2 };

typedef struct {
    uint8_t version;
    uint8_t incompatible; /* bits that a receiver must know, else it refuses the frame */
    uint8_t compatible;   /* bits that a receiver may ignore */
    uint8_t type;
    uint16_t sequence; /* on this link */
    uint8_t epoch;     /* of the exploration that gave numbers */
    uint8_t direction;
    uint16_t first; /* down: the cells first ... first + count - 1; up: the cell it comes from */
    uint16_t count;
    uint32_t time_us;
} skin_header;

/* Collects the bytes of one frame. */
typedef struct {
    uint8_t bytes[SKIN_MAX_ENCODED];
    uint16_t count;
    bool too_long;
} skin_receiver;

/* Writes a frame and its final zero. Returns how many bytes, 0 where the payload is too long. */
size_t skin_frame_encode(const skin_header* header, const uint8_t* payload, size_t length,
                         uint8_t encoded[SKIN_MAX_ENCODED]);

/* Takes one byte. True once it completes a whole frame: `payload` then points into the receiver until the next byte.
 * What is damaged is dropped without a word, whoever sent it will send it again. */
bool skin_frame_push(skin_receiver* receiver, uint8_t byte, skin_header* header, const uint8_t** payload,
                     size_t* length);

/* CRC-32 as zlib, PNG and Ethernet have it: reflected, polynomial 0x04C11DB7, all ones before and inverted after. */
uint32_t skin_crc32(const uint8_t* bytes, size_t count);

#ifdef __cplusplus
}
#endif
#endif
