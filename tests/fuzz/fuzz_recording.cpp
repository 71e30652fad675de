#include "tests/fuzz/fuzz_entry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    skincal::test::readAnything({reinterpret_cast<const char*>(data), size});
    return 0;
}
