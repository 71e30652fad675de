#include "tests/ui/scene3d/baseline.h"

#include <algorithm>
#include <cstdlib>

namespace skincal {
namespace {

constexpr double kTolerance = 0.01;

}  // namespace

double unlikeness(const QImage& a, const QImage& b) {
    if (a.isNull() || a.size() != b.size())
        return 1;
    const QSize half = a.size() / 2;
    const auto blurred = [&](const QImage& picture) {
        return picture.convertToFormat(QImage::Format_RGB32)
            .scaled(half, Qt::IgnoreAspectRatio, Qt::SmoothTransformation)
            .scaled(half / 2, Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
    };
    const QImage first = blurred(a);
    const QImage second = blurred(b);
    constexpr int kUnlike = 42;
    int unlike = 0;
    for (int y = 0; y < first.height(); ++y) {
        for (int x = 0; x < first.width(); ++x) {
            const QRgb p = first.pixel(x, y);
            const QRgb q = second.pixel(x, y);
            const int most =
                std::max({std::abs(qRed(p) - qRed(q)), std::abs(qGreen(p) - qGreen(q)), std::abs(qBlue(p) - qBlue(q))});
            unlike += most > kUnlike ? 1 : 0;
        }
    }
    return static_cast<double>(unlike) / (first.width() * first.height());
}

::testing::AssertionResult matchesBaseline(const QImage& picture, const std::string& name) {
    const QString path = QString(SKINCAL_TEST_DATA "/baselines/%1.png").arg(QString::fromStdString(name));
    if (std::getenv("SKINCAL_UPDATE_BASELINES") != nullptr) {
        if (picture.save(path))
            return ::testing::AssertionSuccess();
        return ::testing::AssertionFailure() << "can't write " << path.toStdString();
    }
    const QImage baseline(path);
    const double unlike = baseline.isNull() ? 1 : unlikeness(picture, baseline);
    if (unlike <= kTolerance)
        return ::testing::AssertionSuccess();
    const QString drawn = QString::fromStdString(name) + "-drawn.png";
    picture.save(drawn);
    return ::testing::AssertionFailure() << (baseline.isNull() ? "there is no baseline " : "differs from ")
                                         << path.toStdString() << ": " << 100 * unlike
                                         << " % of the pixels; what was drawn is in " << drawn.toStdString();
}

}  // namespace skincal
