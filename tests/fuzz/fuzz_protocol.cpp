// Bytes from a broken, or a malicious, skin and computer. The first byte says what of the frames that the rest is cut
// into is mended: without a right CRC, hardly anything would get past it.

#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "tests/fuzz/protocol_entry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    skincal::test::talk({data, size});
    return 0;
}
