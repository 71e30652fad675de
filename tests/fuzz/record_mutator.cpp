// Changes inputs that are lists of records (byte_source.h) by whole records: what is inserted into one does not make
// nonsense of all that follow.

#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/byte_source.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);

namespace skincal::test {
namespace {

constexpr std::size_t kLongest = 255;

struct Records {
    std::uint8_t first = 0;  ///< what comes before them
    std::vector<std::string> list;

    Records(const std::uint8_t* data, std::size_t size) {
        ByteSource from({data, size});
        first = from.byte();
        while (!from.isOver()) {
            const auto bytes = from.record().rest();
            list.emplace_back(bytes.begin(), bytes.end());
        }
    }
    std::size_t write(std::uint8_t* data, std::size_t maxSize) const {
        data[0] = first;
        std::size_t size = 1;
        for (const std::string& record : list) {
            if (size + 1 + record.size() > maxSize)
                break;
            data[size++] = static_cast<std::uint8_t>(record.size());
            std::memcpy(data + size, record.data(), record.size());
            size += record.size();
        }
        return size;
    }
};

void mutate(std::string& record) {
    const std::size_t size = record.size();
    record.resize(kLongest);
    record.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(record.data()), size, kLongest));
}

std::string invent(std::minstd_rand& chance) {
    std::string record(4 + chance() % 20, '\0');
    for (char& byte : record)
        byte = static_cast<char>(chance() >> 8);
    return record;
}

}  // namespace
}  // namespace skincal::test

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                               unsigned seed) {
    using namespace skincal::test;
    std::minstd_rand chance(seed);
    Records records(data, size);
    auto& list = records.list;
    const auto place = [&] { return list.begin() + static_cast<std::ptrdiff_t>(chance() % list.size()); };
    const auto what = list.empty() ? 9 : chance() % 12;
    switch (what) {
        case 0:
            list.erase(place());
            break;
        case 1:
            list.insert(place(), std::string(*place()));
            break;
        case 2:
            std::swap(*place(), *place());
            break;
        case 3:
            records.first = static_cast<std::uint8_t>(chance() >> 8);
            break;
        case 8:
        case 9:
            list.insert(list.empty() ? list.end() : place() + chance() % 2, invent(chance));
            break;
        default:
            mutate(*place());
            break;
    }
    return records.write(data, maxSize);
}

/// The beginning of one and the end of another.
extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* one, std::size_t oneSize,
                                                 const std::uint8_t* other, std::size_t otherSize, std::uint8_t* out,
                                                 std::size_t maxSize, unsigned seed) {
    using namespace skincal::test;
    std::minstd_rand chance(seed);
    Records made(one, oneSize);
    const Records rest(other, otherSize);
    made.list.resize(chance() % (made.list.size() + 1));
    const auto from = static_cast<std::ptrdiff_t>(chance() % (rest.list.size() + 1));
    made.list.insert(made.list.end(), rest.list.begin() + from, rest.list.end());
    return made.write(out, maxSize);
}
