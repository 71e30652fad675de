#pragma once

#include "core/estimation/body_model.h"
#include "core/formats/json_cursor.h"

namespace skincal {

/// Names and ids are taken once, and what is referred to is there: whoever uses a body may look things up blindly.
/// Throws FileErrorException.
/// @param root  what `body` was read from, for the place of a complaint.
void checkBodyReferences(const JsonCursor& root, const BodyModel& body);

}  // namespace skincal
