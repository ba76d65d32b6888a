#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// footing-eval attitude: the attitude of a device with gyroscope and accelerometer.
void AddAttitudeCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
