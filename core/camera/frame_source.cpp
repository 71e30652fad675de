#include "core/camera/frame_source.h"
