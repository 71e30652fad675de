#include "core/vision/word_reading.h"

namespace skincal {

std::string WordReading::sentBits() const {
    std::string bits(planes, '0');
    for (const std::uint32_t plane : sent)
        bits.at(plane) = '1';
    return bits;
}

std::string WordReading::receivedBits() const {
    std::string bits(planes, '0');
    for (const std::uint32_t plane : received)
        bits.at(plane) = '1';
    for (const std::uint32_t plane : disturbed)
        bits.at(plane) = '.';
    return bits;
}

}  // namespace skincal
