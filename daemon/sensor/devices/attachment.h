#pragma once

#include <string>

#include "daemon/sensor/devices/source.h"
#include "footing/v1/device.pb.h"

namespace footing::devices {

/// What is wrong with a simulated device's attachment, or nothing.
std::string WhatIsWrong(const v1::DeviceAttach& attach);

/// The identity that the attachment states.
DeviceIdentity IdentityOf(const v1::DeviceAttach& attach);

}  // namespace footing::devices
