#pragma once

#include <cstdint>

#include "core/simulation/world.h"

namespace skincal {

/// A skin that nobody chose, to find out how well a method does on average and at worst. Drawn uniformly unless said
/// otherwise:
///   body          by seed modulo 4: 0 plane, 1 one cylinder (radius 50 to 120 mm) with patches round it, 2 relief,
///                 3 an arm of cylinders (50 mm) that stand at random
///   patches       2 to 5, of 6 to 23 modules each, round to ragged; wired to each other in half of the worlds
///   sensors       6 to 17 poses, noise 0.01 to 0.1 m/s^2 (log-uniform); bias up to 0.5 m/s^2 and scale up to 0.02,
///                 standard deviations as all noise here
///   play          0.1 to 0.6 mm (log-uniform), tilt up to 0.02 rad, per axis
///   views         4 to 15 from 0.5 to 1.2 m, noise 0.01 to 0.3 px (log-uniform); in half of the worlds up to 20 % of
///                 the detections are false
/// The same seed gives the same world, everywhere and always: figures of different versions compare seed by seed. The
/// scenario's description says what came out.
[[nodiscard]] World randomWorld(std::uint64_t seed);

}  // namespace skincal
