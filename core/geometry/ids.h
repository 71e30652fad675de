#pragma once

#include <compare>
#include <cstdint>
#include <functional>

namespace skincal {

/// An integer that can't be mistaken for another kind of integer.
template <class Tag, class Int = std::uint32_t>
struct StrongId {
    Int value{};
    constexpr StrongId() = default;
    constexpr explicit StrongId(Int v) : value(v) {}
    // clang-tidy 14 takes the comparison's literal 0 for a pointer.
    friend constexpr auto operator<=>(const StrongId&, const StrongId&) = default;  // NOLINT(modernize-use-nullptr)
};

/// The number a module bears in the network and in every file; positive, unique, with gaps.
using ModuleId = StrongId<struct ModuleTag>;
/// A patch, numbered from 0 by the smallest module id it holds.
using PatchId = StrongId<struct PatchTag>;

}  // namespace skincal

template <class Tag, class Int>
struct std::hash<skincal::StrongId<Tag, Int>> {
    std::size_t operator()(const skincal::StrongId<Tag, Int>& id) const noexcept { return std::hash<Int>{}(id.value); }
};
