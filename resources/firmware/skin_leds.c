/* Patterns of light: what a cell shows when, and which it can vouch for having shown. */
#include "skin_parts.h"

static bool lit(const skin_cell* cell, const skin_pattern* pattern) {
    switch (pattern->source) {
        case skincal_wire_Source_ALL:
            return true;
        case skincal_wire_Source_CELL:
            return pattern->argument == cell->tree.number;
        case skincal_wire_Source_WORD:
            return pattern->argument < 64 && ((cell->leds.word >> pattern->argument & 1u) != 0) != pattern->inverted;
        case skincal_wire_Source_MASK:
            return cell->leds.mask != 0;
        default:
            return false;
    }
}

static uint32_t colour_of(const skin_cell* cell, const skin_pattern* pattern) {
    if (!lit(cell, pattern))
        return 0;
    const uint8_t mask = cell->leds.mask;
    if (pattern->source == skincal_wire_Source_MASK && cell->leds.mask_bits == 4)
        return (mask & 1u ? 0xFF0000u : 0) | (mask & 2u ? 0xFF00u : 0) | (mask & 4u ? 0xFFu : 0);
    return pattern->colour ? pattern->colour : 0xFFFFFFu;
}

/* Frames may overtake each other: a mask or a word may still be on its way, and a pattern may come after a newer one.
 */
static bool is_ready(const skin_leds* leds, const skin_pattern* pattern) {
    if (pattern->source == skincal_wire_Source_MASK)
        return leds->has_mask && leds->mask_number == pattern->number;
    return pattern->source != skincal_wire_Source_WORD || (leds->has_word && leds->word_set == pattern->set);
}

static bool is_outdated(const skin_leds* leds, const skin_pattern* pattern) {
    return leds->has_shown && (uint16_t)(pattern->number - leds->newest) >= 0x8000;
}

static void show(skin_cell* cell, const skin_pattern* pattern, uint32_t now) {
    skin_leds* leds = &cell->leds;
    const uint32_t colour = colour_of(cell, pattern);
    cell->board->led(cell->board->context, (uint8_t)(colour >> 16), (uint8_t)(colour >> 8), (uint8_t)colour);
    const uint16_t ahead = (uint16_t)(pattern->number - leds->newest);
    leds->shown = leds->has_shown && ahead < 64 ? leds->shown << ahead | 1u : 1;
    leds->has_shown = true;
    leds->newest = pattern->number;
    leds->late_us = (int32_t)(now - pattern->at);
}

static void queue(skin_cell* cell, const skin_header* header, const uint8_t* payload, size_t length) {
    skin_leds* leds = &cell->leds;
    skincal_wire_Pattern told = skincal_wire_Pattern_init_zero;
    if (!skin_parse(skincal_wire_Pattern_fields, &told, payload, length) ||
        leds->queued == SKIN_QUEUED_PATTERNS) /* the tally will show it */
        return;
    const skin_pattern pattern = {.number = (uint16_t)told.number,
                                  .source = (uint8_t)told.source,
                                  .inverted = told.inverted,
                                  .argument = told.argument,
                                  .colour = told.colour,
                                  .set = told.set,
                                  .at = header->time_us ? header->time_us : skin_link_time(&cell->link)};
    leds->queue[leds->queued++] = pattern;
}

static void mask(skin_cell* cell, const skin_header* header, const uint8_t* payload, size_t length) {
    skincal_wire_Mask told = skincal_wire_Mask_init_zero;
    if (!skin_parse(skincal_wire_Mask_fields, &told, payload, length) || (told.bits_each != 1 && told.bits_each != 4))
        return;
    const uint32_t at = ((uint32_t)cell->tree.number - header->first) * told.bits_each;
    if (at / 8 >= told.lit.size)
        return;
    cell->leds.has_mask = true;
    cell->leds.mask_number = (uint16_t)told.number;
    cell->leds.mask_bits = (uint8_t)told.bits_each;
    cell->leds.mask = (uint8_t)((unsigned)told.lit.bytes[at / 8] >> at % 8 & ((1u << told.bits_each) - 1u));
}

static void word(skin_cell* cell, const skin_header* header, const uint8_t* payload, size_t length) {
    skincal_wire_Words told = skincal_wire_Words_init_zero;
    if (!skin_parse(skincal_wire_Words_fields, &told, payload, length) || told.bytes_each == 0 || told.bytes_each > 8)
        return;
    const uint32_t place = ((uint32_t)cell->tree.number - header->first) * told.bytes_each;
    if (place + told.bytes_each > told.words.size)
        return;
    cell->leds.has_word = true;
    cell->leds.word_set = told.set;
    cell->leds.word = 0;
    for (uint32_t i = 0; i < told.bytes_each; ++i)
        cell->leds.word |= (uint64_t)told.words.bytes[place + i] << 8 * i;
}

void skin_leds_receive(skin_cell* cell, const skin_header* header, const uint8_t* payload, size_t length) {
    switch (header->type) {
        case TYPE_PATTERN:
            queue(cell, header, payload, length);
            break;
        case TYPE_MASK:
            mask(cell, header, payload, length);
            break;
        default:
            word(cell, header, payload, length);
            break;
    }
}

bool skin_leds_have_shown(const skin_cell* cell, uint16_t pattern) {
    const uint16_t behind = (uint16_t)(cell->leds.newest - pattern);
    return cell->leds.has_shown && behind < 64 && (cell->leds.shown >> behind & 1u);
}

static void drop(skin_leds* leds, int place) {
    --leds->queued;
    for (int k = place; k < leds->queued; ++k)
        leds->queue[k] = leds->queue[k + 1];
}

uint32_t skin_leds_run(skin_cell* cell) {
    skin_leds* leds = &cell->leds;
    const uint32_t now = skin_link_time(&cell->link);
    uint32_t wait = UINT32_MAX;
    for (int i = 0; i < leds->queued;) {
        const skin_pattern pattern = leds->queue[i];
        const bool due = skin_reached(now, pattern.at);
        if (is_outdated(leds, &pattern) || (due && is_ready(leds, &pattern))) {
            drop(leds, i);
            if (!is_outdated(leds, &pattern))
                show(cell, &pattern, now);
            i = 0; /* it may have outdated others */
            continue;
        }
        if (!due)
            wait = skin_until(wait, now, pattern.at);
        ++i;
    }
    return wait;
}
