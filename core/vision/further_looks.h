#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "core/vision/coded_scan.h"
#include "core/vision/detection.h"

namespace skincal {

struct FurtherLookOptions {
    std::size_t anchors = 4;      ///< modules that were found, lit again: they tell whether the camera moved meanwhile
    std::size_t maxFrames = 600;  ///< of all further looks of a view together: 20 s at 30 frames/s

    double maxMotion_px = 1;  ///< of the camera since the first look that counts; then there are no more

    [[nodiscard]] bool validate() const { return anchors > 0 && anchors <= 100 && maxMotion_px > 0; }
};

/// What to light again after a scan that left modules undecided. While there is light in the pictures that blinks like
/// no module that was found (ViewDetections::unexplained), those that are missing are looked for among fewer others, by
/// fresh words (codedScan): as many at a time as before where half of them were found, half as many where it was a
/// quarter, else a quarter as many; when all have had their turn, those that are left once more. LEDs that are too
/// close together are so told apart at last, and which pictures a flash spoils is another lot. Those of a look that
/// leaves nothing unexplained are out of sight, and are not looked for again, nor are those that were alone, nor many
/// of whom a whole turn found none, and saw no light of most: then it is the room that hides them. What a knock spoilt
/// is scanned as it was before.
class FurtherLooks {
  public:
    /// @param seed  of the words and of who is looked for together
    explicit FurtherLooks(std::uint64_t seed, const FurtherLookOptions& options = {});

    /// @param view  as decodeView has it after all looks so far
    /// @return what to light next, as a scan of its own; nothing where all is found or known to be out of sight, or
    ///         where it has taken too many pictures.
    [[nodiscard]] std::optional<LitSets> next(const ViewDetections& view);
    /// Those that the look of the last next() is for.
    [[nodiscard]] const std::vector<ModuleId>& wanted() const { return wanted_; }
    /// How many looks there were.
    [[nodiscard]] std::size_t looks() const { return looks_; }

  private:
    /// Those that are to be looked for again, as many at a time as the last turn found to do.
    void beginTurn(std::vector<ModuleId> modules);

    std::uint64_t seed_;
    FurtherLookOptions options_;
    std::deque<std::vector<ModuleId>> waiting_;  ///< in this turn
    std::vector<ModuleId> wanted_;
    std::size_t lastWanted_ = 0;
    std::vector<ModuleId> left_;  ///< of those who had their turn
    std::size_t atATime_ = 0;
    std::size_t inTurn_ = 0;       ///< modules in this turn
    std::size_t foundInTurn_ = 0;  ///< of these
    std::size_t looks_ = 0;
    std::size_t frames_ = 0;
};

}  // namespace skincal
