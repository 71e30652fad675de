#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/estimation/body_model.h"
#include "ui/presenters/tactile_history.h"

namespace skincal {

/// What can be shown of a skin.
enum class Quantity { Proximity, Force, Temperature, Acceleration };

inline constexpr std::array kQuantities{Quantity::Proximity, Quantity::Force, Quantity::Temperature,
                                        Quantity::Acceleration};

/// What colours are spread over, in the quantity's unit: fixed, so that the same colour always means the same.
struct QuantityRange {
    double low = 0;
    double high = 1;
    double rest = 0;  ///< what an untouched skin at rest reads; boards stand out by what is above it
};

[[nodiscard]] QuantityRange rangeOf(Quantity quantity);
/// NaN where the module sent nothing.
[[nodiscard]] float valueOf(const FeltModule& felt, Quantity quantity);

/// A module that something presses on.
struct TouchContact {
    ModuleId module;
    double force = 0;                      ///< N, of all its cells
    std::optional<Vector3d> position_r{};  ///< mean of its force cells, weighted by what they bear; nothing where the
                                           ///< module has no pose in the body
    std::optional<Vector3d> normal_r{};    ///< out of the skin
};

/// One moment of a skin, as the window shows it.
struct TactilePicture {
    std::vector<float> values;           ///< 0 to 1 by position in BodyModel::modules, NaN of what is not known
    std::vector<float> heights;          ///< m, likewise
    std::vector<TouchContact> contacts;  ///< the strongest first
};

inline constexpr std::size_t kMostContacts = 5;

/// Fills a picture anew, in the memory that it has.
/// @param felt  in the order of `body`'s modules
void drawPicture(TactilePicture& picture, std::span<const FeltModule> felt, Quantity quantity, const BodyModel& body);

/// A module's values over time: of each short while the least and the most, so that no peak is lost however narrow the
/// picture is.
struct Trace {
    ModuleId module;
    std::vector<std::pair<float, float>> ranges;  ///< the newest last; NaN where nothing is known
    std::optional<double> shown{};                ///< at the moment that is shown
};

/// The last TactileHistory::kSpan, in so many equal whiles. These begin at multiples of their length, lest peaks
/// change their shape as time goes on.
void drawTrace(Trace& trace, const TactileHistory& history, Quantity quantity, std::size_t whiles);

}  // namespace skincal
