/* A skin cell: what the protocol's specification asks of one, without the hardware. A board gives it a clock, the
 * transmitters of its ports, an LED and sensors (skin_board), hands over what its ports receive and calls
 * skin_cell_run. Everything lives in skin_cell, some 6 KiB; no heap, no globals, for one thread or interrupt level.
 *
 *     skin_cell_init(&cell, &board, &identity, 4, 5000, seed);
 *     for (;;) {
 *         for each byte that port p received: skin_cell_receive(&cell, p, &byte, 1);
 *         skin_cell_run(&cell);
 *     }
 */
#ifndef SKIN_CELL_H
#define SKIN_CELL_H

#include "skin_link.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    SKIN_QUEUED_PATTERNS = 8,
    SKIN_SAMPLE_US = 10000, /* between two readings of the sensors */
};

typedef struct {
    uint8_t unique_id[12];
    char type[16]; /* name of the module template, ends with a zero */
    char name[24]; /* of the firmware, likewise */
    uint32_t firmware;
    uint32_t schema; /* as in message Hello */
} skin_identity;

typedef struct {
    uint8_t epoch;       /* 0: has never been explored */
    int8_t parent;       /* port, -1 none */
    uint8_t children;    /* bit per port */
    uint8_t open;        /* asked, not yet answered */
    uint8_t uncounted;   /* children whose number of cells is not known yet */
    bool reported;       /* own size was told to the parent */
    uint32_t give_up_at; /* on what is open */
    uint16_t below[SKIN_MAX_PORTS];
    uint16_t first[SKIN_MAX_PORTS]; /* number of the child, once assigned */
    uint16_t size;
    uint16_t number;   /* 0 none */
    uint8_t booted;    /* ports behind which somebody has booted, of which the computer was not told yet */
    uint8_t alive;     /* ports on which a neighbour takes part in this exploration */
    uint8_t restarted; /* ports behind which somebody has booted since this exploration began */
    uint8_t newest; /* epoch of neighbours that will not take part in this one, which is no newer; 0: there are none */
    uint32_t introduced_at;
    uint8_t heard; /* ports whose neighbour has told its number */
    uint16_t neighbour[SKIN_MAX_PORTS];
    uint8_t neighbour_port[SKIN_MAX_PORTS];
} skin_tree;

typedef struct {
    uint16_t number;
    uint8_t source;
    bool inverted;
    uint32_t argument;
    uint32_t colour;
    uint32_t set;
    uint32_t at; /* synchronised time */
} skin_pattern;

typedef struct {
    uint64_t word;
    uint32_t word_set;
    bool has_word;
    uint16_t mask_number;
    bool has_mask;
    uint8_t mask;
    uint8_t mask_bits;
    bool has_shown;
    uint16_t newest;
    uint64_t shown; /* bit i: newest - i */
    int32_t late_us;
    uint8_t queued;
    skin_pattern queue[SKIN_QUEUED_PATTERNS];
} skin_leds;

typedef struct {
    uint16_t query;
    uint16_t pattern;
    uint8_t waiting; /* bit per child port */
    uint32_t sum;
    bool asked; /* since the cell was numbered: whether `query` is that of a query */
    bool open;
} skin_tally;

typedef struct {
    uint32_t count;
    float first[3]; /* reading: sums are of differences to it, so that little is lost in rounding */
    float sum[3];
    float squares[3];
} skin_average;

typedef struct {
    skin_average streamed; /* since the last that was sent */
    skin_average measured; /* since the last Measure, until its time is over */
    bool measuring;
    uint32_t run;       /* of what was measured */
    uint32_t asked_run; /* that the computer waits for */
    bool streams[4];    /* by subject */
    bool ordered[4];    /* whether `order` is that of an order */
    uint16_t order[4];
    uint32_t period_us[4];
    uint32_t next_us[4];
    uint32_t sample_at;
    uint32_t measure_until;
    uint8_t change_pct;
    uint8_t told[20]; /* last tactile sample sent */
    bool has_told;    /* since the stream was ordered */
} skin_senses;

typedef struct {
    const skin_board* board;
    const skin_identity* identity;
    skin_link link;
    skin_tree tree;
    skin_leds leds;
    skin_tally tally;
    skin_senses senses;
    uint8_t to_report; /* bit per subject */
} skin_cell;

/* timeout_us: at least what three of the longest frames take.
 * seed: another one at each start, or neighbours take a cell that has just restarted for what it was, and its first
 * frames for such as they have had: noise of a converter, a count of starts in memory that lasts. */
void skin_cell_init(skin_cell* cell, const skin_board* board, const skin_identity* identity, int ports,
                    uint32_t timeout_us, uint32_t seed);

/* Bytes that a port has received. */
void skin_cell_receive(skin_cell* cell, int port, const uint8_t* bytes, size_t count);

/* Does what is due. Call it after receiving and at least as often as it asks for: returns us, UINT32_MAX for never. */
uint32_t skin_cell_run(skin_cell* cell);

#ifdef __cplusplus
}
#endif
#endif
