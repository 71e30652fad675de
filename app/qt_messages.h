#pragma once

namespace skincal {

/// From now on Qt keeps to itself that it finds no sound server and no folder for sockets: nothing here makes a sound,
/// and printed beside an error it is taken for its cause. What else it has to say it says.
void hideWhatQtSaysOfSound();

}  // namespace skincal
