#pragma once

#include <optional>
#include <string_view>

#include "core/device/protocol/cell_poll.h"
#include "core/device/protocol/led_patterns.h"
#include "core/device/protocol/skin.pb.h"

namespace skincal {

/// Nothing where the payload is none of these messages.
template <class T>
[[nodiscard]] std::optional<T> parseWire(std::string_view payload) {
    T message;
    if (!message.ParseFromArray(payload.data(), static_cast<int>(payload.size())))
        return std::nullopt;
    return message;
}

/// Asks some cells for a report.
/// @param run  of wire::REST, the measurement
[[nodiscard]] inline Message reportMessage(wire::Subject subject, std::uint32_t run, const CellRange& cells) {
    wire::Report report;
    report.set_subject(subject);
    report.set_run(run);
    Message message;
    message.header.type = FrameType::Report;
    message.header.direction = FrameDirection::Down;
    message.header.first = cells.first;
    message.header.count = cells.count;
    message.payload = report.SerializeAsString();
    return message;
}

}  // namespace skincal
