#include "ui/pages/mesh_words.h"

#include <algorithm>
#include <cmath>

namespace skincal {

QString MeshWords::mm(double metres) {
    return tr("%1 mm").arg(1e3 * metres, 0, 'f', 2);
}

QString MeshWords::signedMm(double metres) {
    return (metres < 0 ? QStringLiteral("−") : QStringLiteral("+")) + mm(std::abs(metres));
}

QString MeshWords::degrees(double angle) {
    return tr("%1°").arg(angle / kDegree, 0, 'f', 1);
}

std::vector<std::pair<QString, QString>> MeshWords::figuresOf(const MeshComparison& comparison) {
    const std::size_t all = comparison.modules.size() + comparison.unmatched.size();
    const bool isOffsetKnown =
        std::none_of(comparison.doubts.begin(), comparison.doubts.end(),
                     [](const AlignmentDoubt& doubt) { return doubt.kind == AlignmentDoubt::Kind::OffsetUnknown; });
    return {{tr("Modules on the mesh"), tr("%1 of %2").arg(comparison.modules.size()).arg(all)},
            {tr("Deviation (rms)"), mm(comparison.rms)},
            {tr("Deviation (median)"), mm(comparison.median)},
            {tr("95 % are within"), mm(comparison.share95)},
            {tr("Farthest off"),
             tr("%1, module %2").arg(signedMm(comparison.worst.deviation)).arg(comparison.worst.id.value)},
            {tr("All stand off by"), isOffsetKnown ? mm(comparison.offset) : tr("can't be told")},
            {tr("Tilt against the mesh (rms)"), degrees(comparison.angle_rms)},
            {tr("Share of the mesh covered"), tr("%1 %").arg(100 * comparison.covered, 0, 'f', 0)}};
}

}  // namespace skincal
