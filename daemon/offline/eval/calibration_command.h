#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// footing-eval calibration: errors of the camera's pose by marks, gravity and three poses.
void AddCalibrationCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
