#include "skin_cell.h"

#include <pb_decode.h>
#include <pb_encode.h>
#include <string.h>

#include "skin_parts.h"

enum { NEED_FOR_OWN = 2 }; /* buffers that must be free before a cell sends what is its own: others' words pass first */

void skin_cell_init(skin_cell* cell, const skin_board* board, const skin_identity* identity, int ports,
                    uint32_t timeout_us, uint32_t seed) {
    memset(cell, 0, sizeof *cell);
    cell->board = board;
    cell->identity = identity;
    /* Anywhere but where a neighbour may still remember it. */
    const uint32_t start = skin_crc32(identity->unique_id, sizeof identity->unique_id) ^ seed;
    skin_link_init(&cell->link, board, ports, timeout_us, (uint16_t)(start ^ start >> 16));
    cell->tree.parent = -1;
    board->led(board->context, 0, 0, 0);
    skin_say(cell, (uint8_t)((1u << cell->link.ports) - 1), TYPE_BOOTED, SKIN_LOCAL, NULL, NULL);
}

bool skin_parse(const pb_msgdesc_t* fields, void* message, const uint8_t* payload, size_t length) {
    pb_istream_t stream = pb_istream_from_buffer(payload, length);
    return pb_decode(&stream, fields, message);
}

bool skin_say(skin_cell* cell, uint8_t ports, uint8_t type, uint8_t direction, const pb_msgdesc_t* fields,
              const void* message) {
    skin_header header = {.version = SKIN_VERSION,
                          .compatible = SKIN_RELIABLE,
                          .type = type,
                          .epoch = cell->tree.epoch,
                          .direction = direction,
                          .first = cell->tree.number,
                          .count = 1,
                          .time_us = skin_link_time(&cell->link)};
    if (type == TYPE_TACTILE)
        header.compatible = 0;
    skin_buffer* buffer = skin_link_queue(&cell->link, &header, ports);
    if (buffer == NULL)
        return false;
    if (fields != NULL) {
        pb_ostream_t stream = pb_ostream_from_buffer(buffer->payload, sizeof buffer->payload);
        if (!pb_encode(&stream, fields, message)) {
            buffer->waiting = 0; /* can't be: all sizes are bounded */
            return true;
        }
        buffer->length = (uint8_t)stream.bytes_written;
    }
    return true;
}

static bool refuse(skin_cell* cell, int port, uint8_t type, skincal_wire_Refused_Reason reason) {
    if (type == TYPE_REFUSED)
        return true;
    const skincal_wire_Refused refused = {.type = type, .reason = reason};
    return skin_say(cell, (uint8_t)(1u << port), TYPE_REFUSED, SKIN_LOCAL, skincal_wire_Refused_fields, &refused);
}

bool skin_say_hello(skin_cell* cell, int port, bool please_answer) {
    skincal_wire_Hello ours = skincal_wire_Hello_init_zero;
    ours.oldest_version = SKIN_VERSION;
    ours.newest_version = SKIN_VERSION;
    ours.capabilities = (cell->board->acceleration ? 1u : 0u) | (cell->board->tactile ? 2u : 0u) | 4u | 8u;
    ours.schema = cell->identity->schema;
    ours.please_answer = please_answer;
    memcpy(ours.name, cell->identity->name, sizeof ours.name);
    return skin_say(cell, (uint8_t)(1u << port), TYPE_HELLO, SKIN_LOCAL, skincal_wire_Hello_fields, &ours);
}

static bool hello(skin_cell* cell, int port, const skin_header* header, const uint8_t* payload, size_t length) {
    skincal_wire_Hello theirs = skincal_wire_Hello_init_zero;
    if (!skin_parse(skincal_wire_Hello_fields, &theirs, payload, length))
        return refuse(cell, port, TYPE_HELLO, skincal_wire_Refused_Reason_MALFORMED);
    skin_tree_hear_epoch(cell, port, header->epoch);
    return !theirs.please_answer || skin_say_hello(cell, port, false);
}

static void finish_tally(skin_cell* cell) {
    /* Once it has shown the pattern itself: the tally may have overtaken it. */
    if (!cell->tally.open || cell->tally.waiting != 0 || !skin_leds_have_shown(cell, cell->tally.pattern))
        return;
    const skincal_wire_Tallied tallied = {.query = cell->tally.query, .cells = cell->tally.sum + 1};
    if (skin_say(cell, (uint8_t)(1u << cell->tree.parent), TYPE_TALLIED, SKIN_LOCAL, skincal_wire_Tallied_fields,
                 &tallied))
        cell->tally.open = false;
}

static void tally(skin_cell* cell, const uint8_t* payload, size_t length) {
    skincal_wire_Tally query = skincal_wire_Tally_init_zero;
    if (!skin_parse(skincal_wire_Tally_fields, &query, payload, length))
        return;
    if (cell->tally.asked && (int16_t)((uint16_t)query.query - cell->tally.query) < 0)
        return; /* a newer one has overtaken it */
    cell->tally.asked = true;
    cell->tally.query = (uint16_t)query.query;
    cell->tally.pattern = (uint16_t)query.pattern;
    cell->tally.waiting = cell->tree.children;
    cell->tally.sum = 0;
    cell->tally.open = true;
}

static void tallied(skin_cell* cell, int port, const uint8_t* payload, size_t length) {
    skincal_wire_Tallied answer = skincal_wire_Tallied_init_zero;
    if (!skin_parse(skincal_wire_Tallied_fields, &answer, payload, length) || answer.query != cell->tally.query ||
        !(cell->tally.waiting & 1u << port))
        return;
    cell->tally.waiting &= (uint8_t) ~(1u << port);
    cell->tally.sum += answer.cells;
}

/* What a range of cells is told, this one being in it. */
static void obey(skin_cell* cell, const skin_header* header, const uint8_t* payload, size_t length) {
    switch (header->type) {
        case TYPE_REPORT: {
            skincal_wire_Report report = skincal_wire_Report_init_zero;
            if (skin_parse(skincal_wire_Report_fields, &report, payload, length) && (unsigned)report.subject < 4) {
                cell->to_report |= (uint8_t)(1u << report.subject);
                if (report.subject == skincal_wire_Subject_REST)
                    cell->senses.asked_run = report.run;
            }
            break;
        }
        case TYPE_TALLY:
            tally(cell, payload, length);
            break;
        case TYPE_TIME_MARK:
            /* Stamped for the moment at which its last byte came. */
            cell->link.offset_us = header->time_us - skin_now(cell);
            break;
        case TYPE_PATTERN:
        case TYPE_MASK:
        case TYPE_WORDS:
            skin_leds_receive(cell, header, payload, length);
            break;
        case TYPE_MEASURE:
        case TYPE_STREAM:
            skin_senses_receive(cell, header, payload, length);
            break;
        default:
            break; /* of a newer version, for newer cells */
    }
}

static bool from_computer(skin_cell* cell, int port, const skin_header* header, const uint8_t* payload, size_t length) {
    if (port != cell->tree.parent || header->epoch != cell->tree.epoch)
        return true;
    if (cell->tree.number == 0)
        return false; /* its number is still on the way */
    const uint8_t ways = skin_tree_ways(cell, header->first, header->count);
    if (ways != 0) {
        skin_buffer* buffer = skin_link_queue(&cell->link, header, ways);
        if (buffer == NULL)
            return false;
        buffer->header.compatible &= (uint8_t)~SKIN_FIRST;
        memcpy(buffer->payload, payload, length);
        buffer->length = (uint8_t)length;
    }
    if ((uint16_t)(cell->tree.number - header->first) < header->count)
        obey(cell, header, payload, length);
    return true;
}

static bool to_computer(skin_cell* cell, int port, const skin_header* header, const uint8_t* payload, size_t length) {
    if (!(cell->tree.children & 1u << port) || header->epoch != cell->tree.epoch)
        return true;
    skin_buffer* buffer = skin_link_queue(&cell->link, header, (uint8_t)(1u << cell->tree.parent));
    if (buffer == NULL)
        return false;
    buffer->header.compatible &= (uint8_t)~SKIN_FIRST;
    memcpy(buffer->payload, payload, length);
    buffer->length = (uint8_t)length;
    if (header->type == TYPE_TACTILE)
        skin_senses_join(cell, buffer);
    return true;
}

static bool from_neighbour(skin_cell* cell, int port, const skin_header* header, const uint8_t* payload,
                           size_t length) {
    switch (header->type) {
        case TYPE_HELLO:
            return hello(cell, port, header, payload, length);
        case TYPE_TALLIED:
            if (header->epoch == cell->tree.epoch)
                tallied(cell, port, payload, length);
            return true;
        case TYPE_BOOTED:
            /* Whatever was agreed with who was there before is void; the computer has to explore again. */
            skin_link_drop_port(&cell->link, port);
            cell->tree.booted |= (uint8_t)(1u << port);
            cell->tree.restarted |= (uint8_t)(1u << port);
            return true;
        case TYPE_EXPLORE:
        case TYPE_EXPLORED:
        case TYPE_SUBTREE:
        case TYPE_ASSIGN:
        case TYPE_NEIGHBOUR:
            return skin_tree_receive(cell, port, header, payload, length);
        case TYPE_REFUSED:
            return true;
        default:
            return refuse(cell, port, header->type, skincal_wire_Refused_Reason_UNKNOWN_TYPE);
    }
}

static bool handle(skin_cell* cell, int port, const skin_header* header, const uint8_t* payload, size_t length) {
    if (header->incompatible != 0)
        return refuse(cell, port, header->type, skincal_wire_Refused_Reason_UNKNOWN_FLAG);
    switch (header->direction) {
        case SKIN_LOCAL:
            return from_neighbour(cell, port, header, payload, length);
        case SKIN_DOWN:
            return from_computer(cell, port, header, payload, length);
        case SKIN_UP:
            return to_computer(cell, port, header, payload, length);
        default:
            return true;
    }
}

static void take(skin_cell* cell, int port, const skin_header* header, const uint8_t* payload, size_t length) {
    if (header->version != SKIN_VERSION) {
        refuse(cell, port, header->type, skincal_wire_Refused_Reason_OTHER_VERSION);
    } else if (header->type == SKIN_TYPE_ACK) {
        skin_link_acknowledged(&cell->link, port, header);
    } else if (!(header->compatible & SKIN_RELIABLE)) {
        handle(cell, port, header, payload, length);
    } else if (!skin_link_is_new(&cell->link, port, header) || handle(cell, port, header, payload, length)) {
        skin_link_accept(&cell->link, port, header);
    } else {
        skin_link_refuse(&cell->link, port);
    }
}

void skin_cell_receive(skin_cell* cell, int port, const uint8_t* bytes, size_t count) {
    skin_header header;
    const uint8_t* payload = NULL;
    size_t length = 0;
    for (size_t i = 0; i < count; ++i)
        if (skin_frame_push(&cell->link.port[port].receiver, bytes[i], &header, &payload, &length))
            take(cell, port, &header, payload, length);
}

static bool report_cell_info(skin_cell* cell) {
    skincal_wire_CellInfo info = skincal_wire_CellInfo_init_zero;
    memcpy(info.unique_id, cell->identity->unique_id, sizeof info.unique_id);
    memcpy(info.type, cell->identity->type, sizeof info.type);
    info.ports = (uint32_t)cell->link.ports;
    info.firmware = cell->identity->firmware;
    for (int p = 0; p < cell->link.ports; ++p)
        if (cell->tree.heard & 1u << p)
            info.heard[info.heard_count++] = (skincal_wire_CellInfo_Heard){
                .port = (uint32_t)p, .cell = cell->tree.neighbour[p], .neighbour_port = cell->tree.neighbour_port[p]};
    return skin_say(cell, (uint8_t)(1u << cell->tree.parent), TYPE_CELL_INFO, SKIN_UP, skincal_wire_CellInfo_fields,
                    &info);
}

static bool report_latched(skin_cell* cell) {
    const skincal_wire_Latched latched = {.newest = cell->leds.newest,
                                          .shown = cell->leds.has_shown ? cell->leds.shown : 0,
                                          .word = cell->leds.word,
                                          .late_us = cell->leds.late_us};
    return skin_say(cell, (uint8_t)(1u << cell->tree.parent), TYPE_LATCHED, SKIN_UP, skincal_wire_Latched_fields,
                    &latched);
}

static uint32_t report(skin_cell* cell) {
    uint32_t wait = UINT32_MAX;
    for (unsigned subject = 0; subject < 4; ++subject) {
        if (!(cell->to_report & 1u << subject) || skin_link_room(&cell->link) <= NEED_FOR_OWN || cell->tree.number == 0)
            continue;
        bool sent = true;
        switch (subject) {
            case skincal_wire_Subject_CELL_INFO:
                /* A link of which neither end knows yet would be missing without anybody noticing. */
                wait = skin_tree_introduced(cell);
                sent = wait == 0 && report_cell_info(cell);
                wait = wait == 0 ? UINT32_MAX : wait;
                break;
            case skincal_wire_Subject_LATCHED:
                sent = report_latched(cell);
                break;
            default:
                sent = skin_senses_report(cell, (skincal_wire_Subject)subject);
                break;
        }
        if (sent)
            cell->to_report &= (uint8_t) ~(1u << subject);
    }
    return wait;
}

uint32_t skin_cell_run(skin_cell* cell) {
    uint32_t wait = skin_tree_run(cell);
    const uint32_t leds = skin_leds_run(cell);
    const uint32_t senses = skin_senses_run(cell);
    finish_tally(cell);
    const uint32_t reports = report(cell);
    const uint32_t link = skin_link_run(&cell->link);
    if (cell->tree.open & cell->link.silent)
        return 0; /* nobody is there: that may have been the last that the tree waited for */
    wait = leds < wait ? leds : wait;
    wait = senses < wait ? senses : wait;
    wait = reports < wait ? reports : wait;
    return link < wait ? link : wait;
}
