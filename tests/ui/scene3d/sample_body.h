#pragma once

#include <memory>

#include "core/estimation/body_model.h"

namespace skincal {

/// A small body that is the same on every machine, since nothing computes it: patch 0 is a flat flower of seven cells
/// that two views saw, patch 1 a strip of six bent round an arm, seen by the second view only. Uncertainties grow with
/// the number of the module, residuals too.
[[nodiscard]] BodyModel sampleBody();

/// The same before any picture was taken: patches have shapes, but no poses.
[[nodiscard]] BodyModel sampleBodyWithoutPictures();

/// A flat rectangle of cells, placed.
[[nodiscard]] BodyModel sheetOf(std::size_t modules);

[[nodiscard]] inline std::shared_ptr<const BodyModel> shared(BodyModel body) {
    return std::make_shared<const BodyModel>(std::move(body));
}

}  // namespace skincal
