/* What the parts of a cell want of each other. Not for boards. */
#ifndef SKIN_PARTS_H
#define SKIN_PARTS_H

#include "skin.pb.h"
#include "skin_cell.h"

enum {
    TYPE_HELLO = 10,
    TYPE_EXPLORE = 11,
    TYPE_EXPLORED = 12,
    TYPE_SUBTREE = 13,
    TYPE_ASSIGN = 14,
    TYPE_NEIGHBOUR = 15,
    TYPE_CELL_INFO = 16,
    TYPE_BOOTED = 17,
    TYPE_RESTARTED = 18,
    TYPE_REPORT = 20,
    TYPE_PATTERN = 30,
    TYPE_MASK = 31,
    TYPE_WORDS = 32,
    TYPE_LATCHED = 33,
    TYPE_TALLY = 34,
    TYPE_TALLIED = 35,
    TYPE_TIME_MARK = 40,
    TYPE_MEASURE = 50,
    TYPE_REST = 51,
    TYPE_TACTILE = 52,
    TYPE_STREAM = 53,
    TYPE_REFUSED = 60,
};

/* A frame of this cell's own, with a message. False where there is no buffer for it. */
bool skin_say(skin_cell* cell, uint8_t ports, uint8_t type, uint8_t direction, const pb_msgdesc_t* fields,
              const void* message);
bool skin_parse(const pb_msgdesc_t* fields, void* message, const uint8_t* payload, size_t length);
/* Who this is, and by the header which exploration it is in. */
bool skin_say_hello(skin_cell* cell, int port, bool please_answer);

static inline bool skin_reached(uint32_t now, uint32_t when) {
    return (int32_t)(now - when) >= 0;
}
static inline uint32_t skin_now(const skin_cell* cell) {
    return cell->board->now_us(cell->board->context);
}
/* The smaller wait. */
static inline uint32_t skin_until(uint32_t wait, uint32_t now, uint32_t when) {
    const uint32_t left = skin_reached(now, when) ? 0 : when - now;
    return left < wait ? left : wait;
}

/* Each takes what is for it and returns false where it can't for want of a buffer; the frame then comes again. */
bool skin_tree_receive(skin_cell* cell, int port, const skin_header* header, const uint8_t* payload, size_t length);
/* The exploration that a neighbour says it is in. */
void skin_tree_hear_epoch(skin_cell* cell, int port, uint8_t epoch);
uint32_t skin_tree_run(skin_cell* cell);
/* In how many us all neighbours have said their numbers, or are not waited for any longer. */
uint32_t skin_tree_introduced(const skin_cell* cell);
/* Bit per child port below which one of the cells first ... first + count - 1 is. */
uint8_t skin_tree_ways(const skin_cell* cell, uint16_t first, uint16_t count);

void skin_leds_receive(skin_cell* cell, const skin_header* header, const uint8_t* payload, size_t length);
bool skin_leds_have_shown(const skin_cell* cell, uint16_t pattern);
uint32_t skin_leds_run(skin_cell* cell);

void skin_senses_receive(skin_cell* cell, const skin_header* header, const uint8_t* payload, size_t length);
uint32_t skin_senses_run(skin_cell* cell);
bool skin_senses_report(skin_cell* cell, skincal_wire_Subject subject);
/* Adds this cell's sample to a frame that passes, where it has one to send and there is room. */
void skin_senses_join(skin_cell* cell, skin_buffer* passing);

#endif
