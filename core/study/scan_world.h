#pragma once

#include <cstdint>

#include "core/simulation/world.h"
#include "core/study/scan_case.h"

namespace skincal {

/// The view of scanWorld that is scanned: in every second one from here on, a bump of the camera happens.
constexpr std::size_t kScanView = 1;

/// A skin that fills the picture of its camera: patches of up to 50 modules on a relief, smaller modules where so many
/// would not fit. The world has a single view to scan, `kScanView`.
[[nodiscard]] World scanWorld(const ScanCase& what, std::uint64_t seed);

}  // namespace skincal
