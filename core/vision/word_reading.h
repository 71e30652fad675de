#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace skincal {

/// What a spot blinked, against the word of the module that it may be the LED of. Where LEDs are lit one at a time,
/// words are as long as there are modules, and nearly empty: only planes in which something was are kept.
struct WordReading {
    std::size_t planes = 0;             ///< one per picture, or three, blue, green and red, where LEDs shine in colours
    bool coloured = false;              ///< three per picture
    std::vector<std::uint32_t> sent{};  ///< planes in which the LED was lit, ascending
    std::vector<std::uint32_t> received{};   ///< planes in which the spot was bright
    std::vector<std::uint32_t> disturbed{};  ///< planes of which nothing is believed; none of them is in `received`
    double snr = 0;                          ///< its light in one picture over the noise of that
    double margin = 0;  ///< lead over whatever else it could be, in -2 log likelihood; not positive where it has none
    std::size_t look = 0;  ///< FrameInfo::look of the pictures that it was read in

    /// Plane by plane, '1' lit, '0' not.
    [[nodiscard]] std::string sentBits() const;
    /// The same from its brightness; '.' where something disturbed it.
    [[nodiscard]] std::string receivedBits() const;
};

}  // namespace skincal
