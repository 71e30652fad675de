#pragma once

#include <string>
#include <vector>

#include "core/camera/camera_frame.h"
#include "core/camera/v4l2_device.h"

namespace skincal {

/// A camera as a multimedia library lists it.
struct ListedCamera {
    std::string id;           ///< of the library: a counter that tells nothing once the camera was unplugged
    std::string description;  ///< what people call it
    std::vector<FrameFormat> formats;
    std::size_t ordinal = 0;  ///< among those of this description
    std::string node;         ///< path of its Video4Linux node; empty where that is not known for certain

    friend bool operator==(const ListedCamera&, const ListedCamera&) = default;
};

/// Formats without those that differ by nothing that can be seen, largest picture and highest rate first.
[[nodiscard]] std::vector<FrameFormat> withoutDoubles(std::vector<FrameFormat> formats);

/// The format that a camera starts with: the largest of at most 1920 x 1080 at 24 frames/s or more, else the first.
/// All zero where there is none.
[[nodiscard]] FrameFormat usualFormat(const std::vector<FrameFormat>& formats);

/// The list with each camera once, ordinals and nodes filled in. Qt 6.4 lists a camera twice where it is there at the
/// start and reported as new besides. Of cameras with one description as many are kept as there are nodes of that name
/// (the first ones: doubles come at the end), one where there is no such node. Two cameras of one name can't be told
/// apart: they are without node.
[[nodiscard]] std::vector<ListedCamera> withoutDoubles(std::vector<ListedCamera> cameras,
                                                       const std::vector<V4l2Node>& nodes);

/// The same camera as before: by id, else the one of that description and ordinal, else the only one of that
/// description. Null where it is not in the list.
[[nodiscard]] const ListedCamera* findAgain(const std::vector<ListedCamera>& cameras, const ListedCamera& before);

}  // namespace skincal
