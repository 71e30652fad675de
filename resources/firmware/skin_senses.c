/* Accelerometer and touch: averages at rest, and streams. */
#include <string.h>

#include "skin_parts.h"

/* The clock wraps: of what is further ahead than half its range nobody can tell that it isn't over. */
static uint32_t microseconds(uint32_t ms) {
    const uint32_t most = 2000000;
    return (ms < most ? ms : most) * 1000;
}

static bool samples(const skin_cell* cell) {
    return cell->senses.measuring || cell->senses.streams[skincal_wire_Subject_REST];
}

static void add(skin_average* average, const float reading[3]) {
    if (average->count == 0)
        memcpy(average->first, reading, sizeof average->first);
    for (int i = 0; i < 3; ++i) {
        const float difference = reading[i] - average->first[i];
        average->sum[i] += difference;
        average->squares[i] += difference * difference;
    }
    ++average->count;
}

static void begin(skin_cell* cell, skin_average* average) {
    memset(average, 0, sizeof *average);
    if (!samples(cell))
        cell->senses.sample_at = skin_now(cell);
}

void skin_senses_receive(skin_cell* cell, const skin_header* header, const uint8_t* payload, size_t length) {
    skin_senses* senses = &cell->senses;
    const uint32_t now = skin_now(cell);
    if (header->type == TYPE_MEASURE) {
        skincal_wire_Measure told = skincal_wire_Measure_init_zero;
        if (!cell->board->acceleration || !skin_parse(skincal_wire_Measure_fields, &told, payload, length))
            return;
        begin(cell, &senses->measured);
        senses->run = told.run;
        senses->measuring = true;
        senses->measure_until = now + microseconds(told.period_ms);
        return;
    }
    skincal_wire_Stream told = skincal_wire_Stream_init_zero;
    if (!skin_parse(skincal_wire_Stream_fields, &told, payload, length))
        return;
    const unsigned subject = told.subject;
    if ((subject == skincal_wire_Subject_REST && cell->board->acceleration) ||
        (subject == skincal_wire_Subject_TACTILE && cell->board->tactile)) {
        if (senses->ordered[subject] && (int16_t)((uint16_t)told.order - senses->order[subject]) < 0)
            return; /* a newer one has overtaken it */
        senses->ordered[subject] = true;
        senses->order[subject] = (uint16_t)told.order;
        if (subject == skincal_wire_Subject_REST)
            begin(cell, &senses->streamed);
        senses->streams[subject] = told.period_ms > 0;
        senses->period_us[subject] = microseconds(told.period_ms);
        /* Not all cells at once. */
        const uint64_t share = (uint64_t)cell->tree.number * 0x9E3779B1u & 0xFFFFFFFFu;
        senses->next_us[subject] = now + (uint32_t)(share * senses->period_us[subject] >> 32);
        if (subject != skincal_wire_Subject_TACTILE)
            return;
        senses->change_pct = (uint8_t)(told.change_pct < 100 ? told.change_pct : 100);
        senses->has_told = false;
    }
}

static bool send_rest(skin_cell* cell, const skin_average* average, uint32_t run) {
    skincal_wire_Rest rest = skincal_wire_Rest_init_zero;
    rest.count = average->count;
    rest.run = run;
    for (int i = 0; i < 3; ++i) {
        const float n = (float)average->count;
        const float mean = average->count > 0 ? average->sum[i] / n : 0;
        rest.mean[i] = average->count > 0 ? average->first[i] + mean : 0;
        const float spread = average->squares[i] - n * mean * mean;
        rest.variance[i] = average->count > 1 && spread > 0 ? spread / (n - 1) : 0;
    }
    rest.temperature = cell->board->temperature ? cell->board->temperature(cell->board->context) : 0;
    return skin_say(cell, (uint8_t)(1u << cell->tree.parent), TYPE_REST, SKIN_UP, skincal_wire_Rest_fields, &rest);
}

static void put(uint8_t* to, int value) {
    to[0] = (uint8_t)value;
    to[1] = (uint8_t)((unsigned)value >> 8);
}

static void tactile_sample(skin_cell* cell, uint8_t sample[20]) {
    uint16_t proximity = 0;
    uint16_t force_mN[3] = {0, 0, 0};
    float xyz[3] = {0, 0, 0};
    cell->board->tactile(cell->board->context, &proximity, force_mN);
    if (cell->board->acceleration)
        cell->board->acceleration(cell->board->context, xyz);
    const float temperature = cell->board->temperature ? cell->board->temperature(cell->board->context) : 0;
    memset(sample, 0, 20);
    put(sample, cell->tree.number);
    put(sample + 2, proximity);
    for (int i = 0; i < 3; ++i) {
        put(sample + 4 + 2 * i, force_mN[i]);
        put(sample + 12 + 2 * i, (int)(xyz[i] * 100));
    }
    put(sample + 10, (int)(temperature * 100));
}

/* By more than the share of what a value can be: proximity of 65535, force of 10 N. */
static bool changed(const skin_senses* senses, const uint8_t* now) {
    if (senses->change_pct == 0 || !senses->has_told)
        return true;
    const uint8_t* then = senses->told;
    for (int i = 1; i < 5; ++i) {
        const int32_t difference = (then[2 * i] | then[2 * i + 1] << 8) - (now[2 * i] | now[2 * i + 1] << 8);
        const int32_t range = i == 1 ? 65535 : 10000;
        if ((difference < 0 ? -difference : difference) * 100 >= senses->change_pct * range)
            return true;
    }
    return false;
}

static void remember(skin_senses* senses, const uint8_t* sample) {
    memcpy(senses->told, sample, sizeof senses->told);
    senses->has_told = true;
}

/* Whether its turn has come; takes it. */
static bool is_due(skin_senses* senses, skincal_wire_Subject subject, uint32_t now) {
    if (!senses->streams[subject] || !skin_reached(now, senses->next_us[subject]))
        return false;
    senses->next_us[subject] += senses->period_us[subject];
    if (skin_reached(now, senses->next_us[subject]))
        senses->next_us[subject] = now + senses->period_us[subject]; /* it has fallen behind: leave some out */
    return true;
}

void skin_senses_join(skin_cell* cell, skin_buffer* passing) {
    skin_senses* senses = &cell->senses;
    uint8_t sample[20];
    /* A message of one bytes field below 128 is: tag, length, bytes. */
    if (passing->length < 2 || passing->payload[0] != 0x0A || passing->payload[1] >= 128 ||
        passing->length != passing->payload[1] + 2 || passing->payload[1] + 20 >= 128 ||
        !is_due(senses, skincal_wire_Subject_TACTILE, skin_now(cell)))
        return;
    tactile_sample(cell, sample);
    if (!changed(senses, sample))
        return;
    memcpy(passing->payload + passing->length, sample, 20);
    passing->payload[1] = (uint8_t)(passing->payload[1] + 20);
    passing->length = (uint8_t)(passing->length + 20);
    remember(senses, sample);
}

static bool send_tactile(skin_cell* cell, bool only_changed) {
    skincal_wire_Tactile tactile = skincal_wire_Tactile_init_zero;
    if (!cell->board->tactile)
        return true;
    tactile_sample(cell, tactile.samples.bytes);
    if (only_changed && !changed(&cell->senses, tactile.samples.bytes))
        return true;
    tactile.samples.size = 20;
    if (!skin_say(cell, (uint8_t)(1u << cell->tree.parent), TYPE_TACTILE, SKIN_UP, skincal_wire_Tactile_fields,
                  &tactile))
        return false;
    remember(&cell->senses, tactile.samples.bytes);
    return true;
}

bool skin_senses_report(skin_cell* cell, skincal_wire_Subject subject) {
    if (subject == skincal_wire_Subject_TACTILE)
        return send_tactile(cell, false);
    /* The question may have overtaken the order. */
    return !cell->senses.measuring && cell->senses.run == cell->senses.asked_run &&
           send_rest(cell, &cell->senses.measured, cell->senses.run);
}

uint32_t skin_senses_run(skin_cell* cell) {
    skin_senses* senses = &cell->senses;
    const uint32_t now = skin_now(cell);
    uint32_t wait = UINT32_MAX;
    if (senses->measuring)
        wait = skin_until(wait, now, senses->measure_until);
    if (samples(cell)) {
        if (skin_reached(now, senses->sample_at)) {
            float xyz[3];
            cell->board->acceleration(cell->board->context, xyz);
            if (senses->measuring)
                add(&senses->measured, xyz);
            if (senses->streams[skincal_wire_Subject_REST])
                add(&senses->streamed, xyz);
            senses->sample_at += SKIN_SAMPLE_US;
            if (skin_reached(now, senses->sample_at))
                senses->sample_at = now + SKIN_SAMPLE_US;
        }
        wait = skin_until(wait, now, senses->sample_at);
    }
    if (senses->measuring && skin_reached(now, senses->measure_until))
        senses->measuring = false;
    if (cell->tree.number == 0)
        return wait;
    if (is_due(senses, skincal_wire_Subject_REST, now) && senses->streamed.count > 0 &&
        send_rest(cell, &senses->streamed, 0))
        memset(&senses->streamed, 0, sizeof senses->streamed);
    if (is_due(senses, skincal_wire_Subject_TACTILE, now))
        send_tactile(cell, true);
    for (int subject = 0; subject < 4; ++subject)
        if (senses->streams[subject])
            wait = skin_until(wait, now, senses->next_us[subject]);
    return wait;
}
