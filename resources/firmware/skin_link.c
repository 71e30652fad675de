#include "skin_link.h"

#include <string.h>

enum { TYPE_EXPLORE = 11, TYPE_NEIGHBOUR = 15, TYPE_TALLIED = 35, WINDOW = 32 };

static bool reached(uint32_t now, uint32_t when) {
    return (int32_t)(now - when) >= 0;
}

void skin_link_init(skin_link* link, const skin_board* board, int ports, uint32_t timeout_us, uint16_t first_sequence) {
    memset(link, 0, sizeof *link);
    link->board = board;
    link->ports = ports < SKIN_MAX_PORTS ? ports : SKIN_MAX_PORTS;
    link->timeout_us = timeout_us;
    for (int p = 0; p < link->ports; ++p) {
        link->port[p].next_sequence = first_sequence;
        link->port[p].room = SKIN_BUFFERS / 2;
        link->port[p].free_at = board->now_us(board->context);
    }
}

uint32_t skin_link_time(const skin_link* link) {
    return link->board->now_us(link->board->context) + link->offset_us;
}

int skin_link_room(const skin_link* link) {
    int room = 0;
    for (int b = 0; b < SKIN_BUFFERS; ++b)
        room += link->buffer[b].waiting == 0;
    return room;
}

skin_buffer* skin_link_queue(skin_link* link, const skin_header* header, uint8_t ports) {
    for (int b = 0; b < SKIN_BUFFERS; ++b) {
        skin_buffer* buffer = &link->buffer[b];
        if (buffer->waiting != 0)
            continue;
        buffer->header = *header;
        buffer->length = 0;
        buffer->waiting = ports;
        buffer->age = link->made++;
        const uint32_t now = link->board->now_us(link->board->context);
        for (int p = 0; p < link->ports; ++p) {
            buffer->tries[p] = 0;
            buffer->due[p] = now;
            if (ports & 1u << p)
                buffer->sequence[p] = link->port[p].next_sequence++;
        }
        return buffer;
    }
    return NULL;
}

void skin_link_drop_explored(skin_link* link) {
    for (int b = 0; b < SKIN_BUFFERS; ++b) {
        const skin_header* header = &link->buffer[b].header;
        if (header->direction != SKIN_LOCAL || (header->type >= TYPE_EXPLORE && header->type <= TYPE_NEIGHBOUR) ||
            header->type == TYPE_TALLIED)
            link->buffer[b].waiting = 0;
    }
}

void skin_link_drop_port(skin_link* link, int port) {
    for (int b = 0; b < SKIN_BUFFERS; ++b)
        link->buffer[b].waiting &= (uint8_t) ~(1u << port);
}

bool skin_link_is_new(skin_link* link, int port, const skin_header* header) {
    skin_port* p = &link->port[port];
    if (!p->begun)
        return true;
    const int16_t ahead = (int16_t)(header->sequence - p->highest);
    if (ahead > 0 && ahead < 4 * WINDOW)
        return true;
    if (ahead == 0)
        return false;
    if (ahead < 0 && ahead >= -WINDOW)
        return !(p->seen >> (-ahead - 1) & 1u);
    /* Too old, or from somebody who has started anew. */
    if (header->compatible & SKIN_FIRST) {
        p->begun = false;
        return true;
    }
    return ahead > 0;
}

static void owe_ack(skin_link* link, skin_port* port) {
    if (!port->owes_ack)
        port->ack_due = link->board->now_us(link->board->context) + SKIN_ACK_DELAY_US;
    port->owes_ack = true;
}

void skin_link_accept(skin_link* link, int port, const skin_header* header) {
    skin_port* p = &link->port[port];
    owe_ack(link, p);
    if (!p->begun) {
        p->begun = true;
        p->highest = header->sequence;
        p->seen = 0;
        return;
    }
    const int16_t ahead = (int16_t)(header->sequence - p->highest);
    if (ahead > 0) {
        p->seen = ahead < WINDOW ? p->seen << ahead | 1u << (ahead - 1) : 0;
        if (ahead == WINDOW)
            p->seen = 1u << (WINDOW - 1);
        p->highest = header->sequence;
    } else if (ahead < 0 && ahead >= -WINDOW) {
        p->seen |= 1u << (-ahead - 1);
    }
}

void skin_link_refuse(skin_link* link, int port) {
    link->port[port].told_full = true;
}

void skin_link_acknowledged(skin_link* link, int port, const skin_header* ack) {
    skin_port* p = &link->port[port];
    const uint32_t now = link->board->now_us(link->board->context);
    bool any = false;
    uint32_t latest = 0; /* when the last of those that arrived was sent */
    p->acknowledged = true;
    p->room = ack->count < 255 ? (uint8_t)ack->count : 255;
    for (int b = 0; b < SKIN_BUFFERS; ++b) {
        skin_buffer* buffer = &link->buffer[b];
        if (!(buffer->waiting & 1u << port) || buffer->tries[port] == 0)
            continue;
        const int16_t behind = (int16_t)(ack->sequence - buffer->sequence[port]);
        if (behind == 0 || (behind > 0 && behind <= WINDOW && (ack->time_us >> (behind - 1) & 1u))) {
            buffer->waiting &= (uint8_t) ~(1u << port);
            if (!any || (int32_t)(buffer->sent[port] - latest) > 0)
                latest = buffer->sent[port];
            any = true;
        }
    }
    if (!any || p->room == 0)
        return;
    /* Nothing overtakes on a wire: what was sent before something that arrived is lost. */
    for (int b = 0; b < SKIN_BUFFERS; ++b) {
        skin_buffer* buffer = &link->buffer[b];
        if ((buffer->waiting & 1u << port) && buffer->tries[port] > 0 && (int32_t)(latest - buffer->sent[port]) > 0)
            buffer->due[port] = now;
    }
}

static void send_frame(skin_link* link, int port, const skin_header* header, const uint8_t* payload, size_t length) {
    uint8_t encoded[SKIN_MAX_ENCODED];
    const size_t count = skin_frame_encode(header, payload, length, encoded);
    const uint32_t now = link->board->now_us(link->board->context);
    link->port[port].free_at = now + link->board->send(link->board->context, port, encoded, count);
}

static void send_ack(skin_link* link, int port) {
    skin_port* p = &link->port[port];
    const int room = skin_link_room(link) / 2;
    const skin_header header = {.version = SKIN_VERSION,
                                .type = SKIN_TYPE_ACK,
                                .sequence = p->highest,
                                .direction = SKIN_LOCAL,
                                .count = (uint16_t)room,
                                .time_us = p->seen};
    p->owes_ack = false;
    p->told_full = room == 0;
    send_frame(link, port, &header, NULL, 0);
}

static void send_buffer(skin_link* link, int port, skin_buffer* buffer, uint32_t now) {
    const skin_port* p = &link->port[port];
    skin_header header = buffer->header;
    header.sequence = buffer->sequence[port];
    if (!p->acknowledged)
        header.compatible |= SKIN_FIRST;
    if (header.type == SKIN_TYPE_TIME_MARK)
        header.time_us = now + link->offset_us + SKIN_EMPTY_FRAME * link->board->byte_ns / 1000;
    send_frame(link, port, &header, buffer->payload, buffer->length);
    if (!(header.compatible & SKIN_RELIABLE)) {
        buffer->waiting &= (uint8_t) ~(1u << port);
        return;
    }
    /* Nobody may be there to answer an Explore: that has to be found out soon. */
    const int backoff = header.type == TYPE_EXPLORE ? 0 : buffer->tries[port] / 4;
    ++buffer->tries[port];
    buffer->sent[port] = now;
    buffer->due[port] = p->free_at + (link->timeout_us << backoff);
}

/* The oldest that may go out on a port now, and when the next wants to. */
static skin_buffer* next_buffer(skin_link* link, int port, uint32_t now, uint32_t* wait) {
    int under_way = 0;
    uint16_t earliest = 0; /* not acknowledged */
    for (int b = 0; b < SKIN_BUFFERS; ++b) {
        const skin_buffer* buffer = &link->buffer[b];
        if (!(buffer->waiting & 1u << port) || buffer->tries[port] == 0)
            continue;
        if (under_way++ == 0 || (int16_t)(buffer->sequence[port] - earliest) < 0)
            earliest = buffer->sequence[port];
    }
    skin_buffer* oldest = NULL;
    for (int b = 0; b < SKIN_BUFFERS; ++b) {
        skin_buffer* buffer = &link->buffer[b];
        if (!(buffer->waiting & 1u << port))
            continue;
        if (!reached(now, buffer->due[port])) {
            if (buffer->due[port] - now < *wait)
                *wait = buffer->due[port] - now;
            continue;
        }
        if (buffer->tries[port] >= SKIN_TRIES) {
            buffer->waiting &= (uint8_t) ~(1u << port);
            link->silent |= (uint8_t)(1u << port);
            ++link->given_up;
            continue;
        }
        const int limit = link->port[port].room > 0 ? link->port[port].room : 1;
        const bool beyond = under_way > 0 && (int16_t)(buffer->sequence[port] - earliest) >= WINDOW;
        if (buffer->tries[port] == 0 && (under_way >= limit || beyond))
            continue; /* an acknowledgement, or giving up, makes room */
        if (oldest == NULL || (int32_t)(buffer->age - oldest->age) < 0)
            oldest = buffer;
    }
    return oldest;
}

uint32_t skin_link_run(skin_link* link) {
    uint32_t wait = UINT32_MAX;
    for (int port = 0; port < link->ports; ++port) {
        skin_port* p = &link->port[port];
        const uint32_t now = link->board->now_us(link->board->context);
        if (p->told_full && skin_link_room(link) >= 4)
            p->owes_ack = true, p->ack_due = now;
        skin_buffer* buffer = next_buffer(link, port, now, &wait);
        const bool ack = p->owes_ack && reached(now, p->ack_due);
        if ((ack || buffer) && !reached(now, p->free_at)) {
            if (p->free_at - now < wait)
                wait = p->free_at - now;
            continue;
        }
        if (ack)
            send_ack(link, port);
        else if (buffer)
            send_buffer(link, port, buffer, now);
        if (ack || buffer) {
            if (p->free_at - now < wait)
                wait = p->free_at - now;
        } else if (p->owes_ack && p->ack_due - now < wait) {
            wait = p->ack_due - now;
        }
    }
    return wait;
}
