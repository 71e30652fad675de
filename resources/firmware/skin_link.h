/* The links of one cell to its neighbours: what is to be acknowledged is sent again until it is, at most so often, and
 * nothing is taken twice. Frames may overtake each other. One frame at a time is with the transmitter of a port; all
 * others wait in a common pool. Portable C99 without a heap. */
#ifndef SKIN_LINK_H
#define SKIN_LINK_H

#include "skin_frame.h"

#ifdef __cplusplus
extern "C" {
#endif

#ifndef SKIN_MAX_PORTS
#define SKIN_MAX_PORTS 4
#endif
#ifndef SKIN_BUFFERS
#define SKIN_BUFFERS 12
#endif

enum {
    SKIN_TRIES = 16,         /* the wait for an acknowledgement doubles with every fourth */
    SKIN_ACK_DELAY_US = 400, /* so that one acknowledges several */
    SKIN_TYPE_ACK = 1,
    SKIN_TYPE_TIME_MARK = 40,
};

/* What a board gives its cell. All are called from skin_cell_* only, none may call those. */
typedef struct {
    void* context;
    uint32_t byte_ns; /* that one byte takes on a port */
    /* Microseconds of a clock that wraps. */
    uint32_t (*now_us)(void* context);
    /* Begins to send on a port; the bytes are the caller's again on return. Returns how long that will take, us. */
    uint32_t (*send)(void* context, int port, const uint8_t* bytes, size_t count);
    void (*led)(void* context, uint8_t red, uint8_t green, uint8_t blue);
    /* Specific force in the cell's frame, m/s^2. */
    void (*acceleration)(void* context, float xyz[3]);
    float (*temperature)(void* context); /* degrees Celsius */
    /* As in message Tactile, without the cell. */
    void (*tactile)(void* context, uint16_t* proximity, uint16_t force_mN[3]);
} skin_board;

typedef struct {
    skin_header header;
    uint8_t length;
    uint8_t waiting; /* bit per port that still has to get it, or to acknowledge it */
    uint8_t tries[SKIN_MAX_PORTS];
    uint16_t sequence[SKIN_MAX_PORTS];
    uint32_t sent[SKIN_MAX_PORTS]; /* the last time */
    uint32_t due[SKIN_MAX_PORTS];  /* not before */
    uint32_t age;
    uint8_t payload[SKIN_MAX_PAYLOAD];
} skin_buffer;

typedef struct {
    /* sending */
    uint16_t next_sequence;
    bool acknowledged;
    uint8_t room; /* that the other side said it has */
    uint32_t free_at;
    /* receiving */
    bool begun;
    uint16_t highest;
    uint32_t seen; /* bit i: highest - 1 - i has come */
    bool owes_ack;
    uint32_t ack_due;
    bool told_full;
    skin_receiver receiver;
} skin_port;

typedef struct {
    const skin_board* board;
    int ports;
    uint32_t timeout_us; /* until a frame that was not acknowledged is sent again */
    skin_port port[SKIN_MAX_PORTS];
    skin_buffer buffer[SKIN_BUFFERS];
    uint32_t made;      /* buffers ever taken: their age */
    uint32_t offset_us; /* synchronised time minus the board's */
    uint32_t given_up;  /* frames that no neighbour acknowledged, ever */
    uint8_t silent;     /* bit per port: a frame was given up on; for whoever wants to know, who also clears it */
} skin_link;

/* timeout_us: at least what three of the longest frames take. */
void skin_link_init(skin_link* link, const skin_board* board, int ports, uint32_t timeout_us, uint16_t first_sequence);

/* Synchronised time, us. */
uint32_t skin_link_time(const skin_link* link);

int skin_link_room(const skin_link* link);

/* Queues a frame for the ports of a mask. Null where all buffers are taken; else the caller fills in payload and length
 * at once. */
skin_buffer* skin_link_queue(skin_link* link, const skin_header* header, uint8_t ports);

/* Forgets what belongs to an exploration that has ended: all but what a neighbour is told whatever the numbers are.
 * Epochs wrap: what waits for long might be taken for a newer one's. */
void skin_link_drop_explored(skin_link* link);

/* Forgets what has not been acknowledged on a port. */
void skin_link_drop_port(skin_link* link, int port);

/* Whether a frame that came is new. It counts as come only once skin_link_accept is called. */
bool skin_link_is_new(skin_link* link, int port, const skin_header* header);
void skin_link_accept(skin_link* link, int port, const skin_header* header);
/* It is not taken for want of a buffer, and will come again. */
void skin_link_refuse(skin_link* link, int port);
void skin_link_acknowledged(skin_link* link, int port, const skin_header* ack);

/* Sends what is due. Returns in how many us it wants to be called again at the latest, UINT32_MAX for never. */
uint32_t skin_link_run(skin_link* link);

#ifdef __cplusplus
}
#endif
#endif
