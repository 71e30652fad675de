#pragma once

#include "core/estimation/body_solution.h"

namespace skincal {

/// Names the poses in which the body shook, the accelerometers and the views that are far noisier than the others, from
/// the noise that the refinement gave each of them.
void noteNoiseFindings(BodySolution& solution);

}  // namespace skincal
