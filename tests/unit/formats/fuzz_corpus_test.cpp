#include <gtest/gtest.h>

#include "tests/fuzz/fuzz_entry.h"
#include "tests/unit/formats/temporary_directory.h"

namespace skincal {
namespace {

// The fuzzer's seeds, and each cut short at every byte, through the fuzzer's own entry: returning is the test.
TEST(FuzzCorpus, EveryInputIsRead) {
    std::size_t inputs = 0;
    for (const auto& entry : std::filesystem::directory_iterator(SKINCAL_FUZZ_CORPUS)) {
        const std::string bytes = test::readText(entry.path());
        for (std::size_t n = 0; n <= bytes.size(); ++n)
            EXPECT_NO_THROW(test::readAnything(std::string_view(bytes).substr(0, n)));
        ++inputs;
    }
    EXPECT_GE(inputs, 5U);
}

}  // namespace
}  // namespace skincal
