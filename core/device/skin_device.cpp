#include "core/device/skin_device.h"
