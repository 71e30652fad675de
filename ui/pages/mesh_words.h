#pragma once

#include <QCoreApplication>
#include <utility>
#include <vector>

#include "core/mesh/mesh_comparison.h"

namespace skincal {

/// Figures of a comparison with a mesh, in the user's language.
class MeshWords {
    Q_DECLARE_TR_FUNCTIONS(MeshWords)
  public:
    [[nodiscard]] static QString mm(double metres);
    /// With its sign, plus included.
    [[nodiscard]] static QString signedMm(double metres);
    [[nodiscard]] static QString degrees(double angle);
    /// What, and its figure.
    [[nodiscard]] static std::vector<std::pair<QString, QString>> figuresOf(const MeshComparison& comparison);
};

}  // namespace skincal
