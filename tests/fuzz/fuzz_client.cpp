// The computer's side, with a skin that says anything.

#include "tests/fuzz/client_entry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    skincal::test::hearAsComputer({data, size});
    return 0;
}
