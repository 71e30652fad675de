#pragma once

#include <cstddef>
#include <cstdint>

namespace skincal {

/// Why a picture was not passed on.
enum class FrameFault : std::uint8_t {
    Empty,             ///< no pixels, or a format that cannot be read
    WrongSize,         ///< not the size that was asked for
    TestPicture,       ///< the colour bars that Qt Multimedia shows in the place of a camera that is not there
    RepeatedSequence,  ///< its number does not rise
    RepeatedTime,      ///< its time does not rise
    Stale,             ///< exposed too long ago, or before the source was started
    FromTheFuture,     ///< exposed after now
    RepeatedContent,   ///< pixel by pixel the picture before
};
inline constexpr std::size_t kFrameFaults = 8;

/// Why a source of pictures ended.
enum class CameraTrouble : std::uint8_t {
    NotPluggedIn,  ///< when it was to be started
    Unplugged,     ///< while it ran
    NoFirstPicture,
    Silent,       ///< pictures came, and come no more
    Frozen,       ///< the same picture again and again
    TestPicture,  ///< see FrameFault
    WrongSize,
    Late,        ///< pictures are exposed too long before they come
    Unsteady,    ///< times or numbers do not rise
    Unreadable,  ///< a format of pixels that cannot be read
    Forbidden,   ///< the operating system does not let this user open it
    Busy,        ///< another program has it
    CannotOpen,  ///< for a reason that the multimedia library gives
    Missing,     ///< no such file
    CannotPlay,  ///< no video, or of a kind that cannot be decoded
    Ended,       ///< the file or stream is over
};

}  // namespace skincal
