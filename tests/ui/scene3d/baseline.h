#pragma once

#include <gtest/gtest.h>

#include <QImage>
#include <string>

namespace skincal {

/// How unlike two pictures are: the share of pixels that differ by more than a sixth of the whole range in a colour,
/// after both were blurred a little, since edges and letters fall a pixel aside between drivers. 1 for other sizes.
[[nodiscard]] double unlikeness(const QImage& a, const QImage& b);

/// Compares a picture with tests/data/baselines/<name>.png. Fails where that is missing or unlike by more than 1 %, and
/// then leaves what was drawn in the working directory, as <name>-drawn.png. With SKINCAL_UPDATE_BASELINES=1 in the
/// environment writes the baseline instead.
[[nodiscard]] ::testing::AssertionResult matchesBaseline(const QImage& picture, const std::string& name);

}  // namespace skincal
