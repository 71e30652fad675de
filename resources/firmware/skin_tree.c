/* How numbers are given. The computer's Explore floods the network; whom a cell hears first is its parent. Sizes of
 * subtrees come back, numbers go out, first a cell and then its descendants: a range of numbers is a branch, and any
 * cell knows from two numbers per port where a frame has to go. */
#include <string.h>

#include "skin_parts.h"

enum {
    ANSWER_US = 400000,      /* that an Explore gets an answer beyond its acknowledgement */
    INTRODUCTION_US = 500000 /* that a neighbour takes to say its number once this cell has one */
};

static uint8_t bit(int port) {
    return (uint8_t)(1u << port);
}

static bool answer(skin_cell* cell, int port, bool child) {
    const skincal_wire_Explored explored = {.child = child, .port = (uint32_t)port};
    return skin_say(cell, bit(port), TYPE_EXPLORED, SKIN_LOCAL, skincal_wire_Explored_fields, &explored);
}

static bool is_newer(uint8_t epoch, uint8_t than) {
    return (int8_t)(epoch - than) > 0;
}

static void note_epoch(skin_tree* tree, uint32_t epoch) {
    if (epoch > 0 && epoch <= 0xFF && !is_newer(tree->newest != 0 ? tree->newest : tree->epoch, (uint8_t)epoch))
        tree->newest = (uint8_t)epoch;
}

static bool explore(skin_cell* cell, int port, uint8_t epoch) {
    skin_tree* tree = &cell->tree;
    if (epoch == 0)
        return true;
    /* Of one that has ended, or of a computer that was never told how far they are: as where the first cell of all,
     * whom it asked, has restarted since. */
    const bool is_over = epoch == tree->epoch ? (tree->restarted & bit(port)) != 0 : !is_newer(epoch, tree->epoch);
    /* The one that it is in is void where neighbours did not take part: then any other will do. */
    if (tree->epoch != 0 && is_over && (epoch == tree->epoch || tree->newest == 0))
        return skin_say_hello(cell, port, false);
    if (epoch == tree->epoch) {
        tree->alive |= bit(port);
        return answer(cell, port, port == tree->parent);
    }
    skin_link_drop_explored(&cell->link);
    if (skin_link_room(&cell->link) < 2)
        return false;
    memset(tree, 0, sizeof *tree);
    tree->epoch = epoch;
    tree->parent = (int8_t)port;
    tree->alive = bit(port);
    tree->open = (uint8_t)(((1u << cell->link.ports) - 1) & ~bit(port));
    tree->give_up_at = skin_now(cell) + ANSWER_US;
    cell->to_report = 0;
    cell->tally.open = false;
    cell->tally.asked = false;
    cell->leds.has_shown = false; /* another computer may number patterns otherwise */
    cell->leds.has_mask = false;
    cell->leds.has_word = false; /* it has another number now */
    cell->leds.queued = 0;
    cell->link.silent = 0;
    memset(cell->senses.streams, 0, sizeof cell->senses.streams);
    memset(cell->senses.ordered, 0, sizeof cell->senses.ordered);
    cell->senses.measuring = false;
    answer(cell, port, true);
    if (tree->open != 0)
        skin_say(cell, tree->open, TYPE_EXPLORE, SKIN_LOCAL, NULL, NULL);
    return true;
}

static void explored(skin_cell* cell, int port, const uint8_t* payload, size_t length) {
    skin_tree* tree = &cell->tree;
    skincal_wire_Explored theirs = skincal_wire_Explored_init_zero;
    if (!skin_parse(skincal_wire_Explored_fields, &theirs, payload, length) || !(tree->open & bit(port)))
        return;
    tree->open &= (uint8_t)~bit(port);
    tree->alive |= bit(port);
    if (theirs.child) {
        tree->children |= bit(port);
        tree->uncounted |= bit(port);
    }
}

static void subtree(skin_cell* cell, int port, const uint8_t* payload, size_t length) {
    skin_tree* tree = &cell->tree;
    skincal_wire_Subtree theirs = skincal_wire_Subtree_init_zero;
    if (port == tree->parent || !skin_parse(skincal_wire_Subtree_fields, &theirs, payload, length))
        return;
    if (tree->reported) {
        /* A branch that was given up too early: it has no numbers. The computer should begin again. */
        if (!(tree->children & bit(port)))
            tree->booted |= bit(port);
        return;
    }
    /* It may have overtaken the answer, or the answer was lost for good: only a child says this. */
    tree->open &= (uint8_t)~bit(port);
    tree->children |= bit(port);
    tree->uncounted &= (uint8_t)~bit(port);
    tree->below[port] = (uint16_t)(theirs.cells < 0xFFFF ? theirs.cells : 0xFFFF);
    note_epoch(tree, theirs.newest_epoch);
}

void skin_tree_hear_epoch(skin_cell* cell, int port, uint8_t epoch) {
    skin_tree* tree = &cell->tree;
    /* Who was asked to take part and says this instead will not. */
    if (!(tree->open & bit(port)) || is_newer(tree->epoch, epoch))
        return;
    tree->open &= (uint8_t)~bit(port);
    note_epoch(tree, epoch);
}

static bool assign(skin_cell* cell, int port, const uint8_t* payload, size_t length) {
    skin_tree* tree = &cell->tree;
    skincal_wire_Assign given = skincal_wire_Assign_init_zero;
    if (port != tree->parent || !tree->reported || tree->number != 0 ||
        !skin_parse(skincal_wire_Assign_fields, &given, payload, length) || given.first == 0 || given.first > 0xFFFF)
        return true;
    int needed = cell->link.ports;
    for (int p = 0; p < cell->link.ports; ++p)
        needed += (tree->children & bit(p)) != 0;
    if (skin_link_room(&cell->link) < needed)
        return false;
    tree->number = (uint16_t)given.first;
    tree->introduced_at = skin_now(cell) + INTRODUCTION_US;
    uint16_t next = (uint16_t)(tree->number + 1);
    for (int p = 0; p < cell->link.ports; ++p) {
        if (!(tree->children & bit(p)))
            continue;
        tree->first[p] = next;
        const skincal_wire_Assign theirs = {.first = next};
        skin_say(cell, bit(p), TYPE_ASSIGN, SKIN_LOCAL, skincal_wire_Assign_fields, &theirs);
        next = (uint16_t)(next + tree->below[p]);
    }
    for (int p = 0; p < cell->link.ports; ++p) {
        const skincal_wire_Neighbour me = {.cell = tree->number, .port = (uint32_t)p};
        if (!(cell->link.silent & bit(p)))
            skin_say(cell, bit(p), TYPE_NEIGHBOUR, SKIN_LOCAL, skincal_wire_Neighbour_fields, &me);
    }
    return true;
}

static void neighbour(skin_cell* cell, int port, const uint8_t* payload, size_t length) {
    skin_tree* tree = &cell->tree;
    skincal_wire_Neighbour theirs = skincal_wire_Neighbour_init_zero;
    if (!skin_parse(skincal_wire_Neighbour_fields, &theirs, payload, length) || theirs.cell > 0xFFFF ||
        theirs.port > 0xFF)
        return;
    tree->heard |= bit(port);
    tree->neighbour[port] = (uint16_t)theirs.cell;
    tree->neighbour_port[port] = (uint8_t)theirs.port;
}

bool skin_tree_receive(skin_cell* cell, int port, const skin_header* header, const uint8_t* payload, size_t length) {
    if (header->type == TYPE_EXPLORE)
        return explore(cell, port, header->epoch);
    if (header->epoch != cell->tree.epoch || cell->tree.parent < 0)
        return true;
    switch (header->type) {
        case TYPE_EXPLORED:
            explored(cell, port, payload, length);
            return true;
        case TYPE_SUBTREE:
            subtree(cell, port, payload, length);
            return true;
        case TYPE_ASSIGN:
            return assign(cell, port, payload, length);
        default:
            neighbour(cell, port, payload, length);
            return true;
    }
}

static void tell_of_booted(skin_cell* cell) {
    skin_tree* tree = &cell->tree;
    for (int p = 0; p < cell->link.ports && tree->number != 0 && tree->booted != 0; ++p) {
        const skincal_wire_Restarted restarted = {.port = (uint32_t)p};
        if ((tree->booted & bit(p)) &&
            skin_say(cell, bit(tree->parent), TYPE_RESTARTED, SKIN_UP, skincal_wire_Restarted_fields, &restarted))
            tree->booted &= (uint8_t)~bit(p);
    }
}

uint32_t skin_tree_introduced(const skin_cell* cell) {
    const skin_tree* tree = &cell->tree;
    if (tree->number == 0)
        return UINT32_MAX;
    return (tree->alive & ~tree->heard) == 0 ? 0 : skin_until(UINT32_MAX, skin_now(cell), tree->introduced_at);
}

uint32_t skin_tree_run(skin_cell* cell) {
    skin_tree* tree = &cell->tree;
    tell_of_booted(cell);
    if (tree->parent < 0 || tree->reported)
        return UINT32_MAX;
    const uint32_t now = skin_now(cell);
    tree->open &= (uint8_t)~cell->link.silent;
    if (skin_reached(now, tree->give_up_at))
        tree->open = 0;
    if (tree->open != 0)
        return skin_until(UINT32_MAX, now, tree->give_up_at);
    if (tree->uncounted != 0)
        return UINT32_MAX;
    uint32_t size = 1;
    for (int p = 0; p < cell->link.ports; ++p)
        if (tree->children & bit(p))
            size += tree->below[p];
    tree->size = (uint16_t)(size < 0xFFFF ? size : 0xFFFF);
    const skincal_wire_Subtree mine = {.cells = size, .newest_epoch = tree->newest};
    tree->reported = skin_say(cell, bit(tree->parent), TYPE_SUBTREE, SKIN_LOCAL, skincal_wire_Subtree_fields, &mine);
    return tree->reported ? UINT32_MAX : 1000;
}

uint8_t skin_tree_ways(const skin_cell* cell, uint16_t first, uint16_t count) {
    const skin_tree* tree = &cell->tree;
    uint8_t ways = 0;
    for (int p = 0; p < cell->link.ports; ++p)
        if ((tree->children & bit(p)) && tree->first[p] != 0 && first < (uint32_t)tree->first[p] + tree->below[p] &&
            tree->first[p] < (uint32_t)first + count)
            ways |= bit(p);
    return ways;
}
