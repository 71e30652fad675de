#pragma once

#include <array>
#include <cstdint>

namespace skincal {

/// Colours for things of a kind, 0xRRGGBB: those of Okabe and Ito ("Color Universal Design", 2008) less black, and a
/// brown, which people of any colour vision tell from the other seven, where a grey is their reddish purple to those
/// who do not see green. What comes after the eighth needs a number or a shape besides.
inline constexpr std::array<std::uint32_t, 8> kKinds{0x0072b2, 0xe69f00, 0x009e73, 0xcc79a7,
                                                     0x56b4e9, 0xd55e00, 0xf0e442, 0x6b4a2b};

}  // namespace skincal
