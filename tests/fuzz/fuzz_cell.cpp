// A reference cell between a computer and neighbours that say anything.

#include "tests/fuzz/cell_entry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    skincal::test::hearAsCell({data, size});
    return 0;
}
