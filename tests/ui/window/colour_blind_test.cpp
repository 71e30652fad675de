// Colours that mean something are told apart by people who see red, green or blue not as others do.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>

#include "ui/pages/demo_page.h"
#include "ui/palette.h"
#include "ui/presenters/board_sign.h"
#include "ui/scene3d/colour_map.h"
#include "ui/widgets/theme.h"

namespace skincal {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Vision {
    const char* name;
    Matrix3d sees;  ///< of linear red, green and blue
};

Matrix3d rows(std::array<double, 9> values) {
    return Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
}

/// Machado, Oliveira and Fernandes, "A physiologically-based model for simulation of color vision deficiency", 2009,
/// where the deficiency is complete.
std::vector<Vision> visions() {
    return {{"common", Matrix3d::Identity()},
            {"protanopia",
             rows({0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998})},
            {"deuteranopia",
             rows({0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881})},
            {"tritanopia",
             rows({1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900})}};
}

double linear(double share) {
    return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}

/// CIELAB of what is seen, under the white of sRGB.
Vector3d labOf(const Vector3d& rgb, const Vision& vision) {
    const Matrix3d toXyz =
        rows({0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920, 0.9503041});
    const Vector3d seen = (vision.sees * rgb.unaryExpr(&linear)).cwiseMax(0).cwiseMin(1);
    const Vector3d f = (toXyz * seen).cwiseQuotient(Vector3d(0.95047, 1, 1.08883)).unaryExpr([](double t) {
        return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116;
    });
    return {116 * f.y() - 16, 500 * (f.x() - f.y()), 200 * (f.y() - f.z())};
}

Vector3d labOf(const QColor& colour, const Vision& vision) {
    return labOf(Vector3d(colour.redF(), colour.greenF(), colour.blueF()), vision);
}

Vector3d labOf(const Rgb& colour, const Vision& vision) {
    return labOf(Vector3d(colour[0], colour[1], colour[2]) / 255, vision);
}

/// A difference of 2.3 is just seen where colours meet; those of small things far apart need several times that.
constexpr double kTold = 13;
/// Of what must be seen at a glance.
constexpr double kApart = 40;

TEST(ColourBlind, PatchesAreToldApart) {
    for (const Vision& vision : visions()) {
        for (unsigned i = 0; i < kKinds.size(); ++i) {
            for (unsigned k = 0; k < i; ++k)
                EXPECT_GT((labOf(patchTint(i), vision) - labOf(patchTint(k), vision)).norm(), kTold)
                    << vision.name << ": " << i << " and " << k;
        }
    }
}

TEST(ColourBlind, TracedModulesAreToldApartInBothThemes) {
    for (const bool isDark : {false, true}) {
        for (const Vision& vision : visions()) {
            for (std::size_t i = 0; i < 4; ++i) {
                for (std::size_t k = 0; k < i; ++k)
                    EXPECT_GT((labOf(traceColour(i, isDark), vision) - labOf(traceColour(k, isDark), vision)).norm(),
                              kTold)
                        << vision.name << ": " << i << " and " << k;
            }
        }
    }
}

TEST(ColourBlind, BoardsAreToldApartByColourOrShape) {
    for (const Vision& vision : visions()) {
        for (std::size_t i = 0; i < 32; ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                const BoardSign a = boardSign(i);
                const BoardSign b = boardSign(k);
                EXPECT_TRUE(a.shape != b.shape || (labOf(a.colour, vision) - labOf(b.colour, vision)).norm() > kTold)
                    << vision.name << ": " << i << " and " << k;
            }
        }
    }
    EXPECT_NE(pictureOf(boardSign(0)), pictureOf(boardSign(8))) << "the shape shows";
}

TEST(ColourBlind, MoreIsBrighterAndStepsOfATenthAreSeen) {
    constexpr int kSteps = 10;
    for (const bool isDark : {false, true}) {
        for (const Vision& vision : visions()) {
            for (int i = 0; i < kSteps; ++i) {
                const Vector3d less = labOf(valueColour(i / 10.0, isDark), vision);
                const Vector3d more = labOf(valueColour((i + 1) / 10.0, isDark), vision);
                EXPECT_GT(more.x(), less.x() + 3) << vision.name << ": " << i;
                EXPECT_GT((more - less).norm(), 6) << vision.name << ": " << i;
            }
            const Vector3d least = labOf(valueColour(0, isDark), vision);
            const Vector3d most = labOf(valueColour(1, isDark), vision);
            const Vector3d half = labOf(valueColour(0.5, isDark), vision);
            EXPECT_GT((most - least).norm(), kApart) << vision.name;
            EXPECT_GT((half - least).norm(), 0.5 * kApart) << vision.name;
            EXPECT_GT((most - half).norm(), 0.5 * kApart) << vision.name;
        }
    }
}

TEST(ColourBlind, AboveIsToldFromBelowAndBothFromTheMiddle) {
    for (const Vision& vision : visions()) {
        const Vector3d middle = labOf(divergingColour(0.5), vision);
        for (const double off : {0.25, 0.3, 0.4, 0.5}) {
            const Vector3d below = labOf(divergingColour(0.5 - off), vision);
            const Vector3d above = labOf(divergingColour(0.5 + off), vision);
            EXPECT_GT((above - below).norm(), kApart) << vision.name << ": " << off;
            EXPECT_GT((above - middle).norm(), 0.5 * kApart) << vision.name << ": " << off;
            EXPECT_GT((below - middle).norm(), 0.5 * kApart) << vision.name << ": " << off;
        }
    }
}

TEST(ColourBlind, GoodIsToldFromWhatNeedsALook) {
    for (const Theme& theme : {Theme::light(), Theme::dark()}) {
        for (const Vision& vision : visions()) {
            EXPECT_GT((labOf(theme.good, vision) - labOf(theme.attention, vision)).norm(), kApart) << vision.name;
            EXPECT_GT((labOf(theme.good, vision) - labOf(theme.bad, vision)).norm(), kApart) << vision.name;
        }
    }
}

}  // namespace
}  // namespace skincal
