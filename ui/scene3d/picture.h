#pragma once

#include <string>
#include <tl/expected.hpp>

#include "core/estimation/body_model.h"

namespace skincal {

struct PictureOptions {
    int width = 1600;
    int height = 900;
    bool dark = false;

    [[nodiscard]] bool validate() const { return width >= 64 && height >= 64 && width <= 8192 && height <= 8192; }
};

/// Draws a body off-screen and returns the picture as PNG bytes: boards coloured by patch, LEDs, cameras, a scale bar
/// and a legend. Needs an X display (VTK as Debian builds it has no other way); the error is a sentence.
[[nodiscard]] tl::expected<std::string, std::string> drawPicture(const BodyModel& body,
                                                                 const PictureOptions& options = {});

}  // namespace skincal
