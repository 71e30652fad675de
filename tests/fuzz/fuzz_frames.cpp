// Bytes as they may come over a wire, through the decoders of both ends.

#include "tests/fuzz/frames_entry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    skincal::test::takeApart({data, size});
    return 0;
}
