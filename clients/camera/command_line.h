#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "clients/camera/source.h"

namespace footing::camera {

/// What every command of footing-camera takes.
struct CommandLine {
  std::string camera_file;
  FrameOptions frames;
  bool json = false, quiet = false;
};

void AddCommandLine(CLI::App& app, CommandLine& line);

/// A usage error unless a camera file and one source of frames are named.
Result<void> Check(const CommandLine& line);

/// A camera's exposure is the command line's; that of other frames is the camera file's.
void TakeExposure(const CommandLine& line, frames::CameraFile& camera);

/// footing-camera calibrate and lens; `exit_code` is set when one has run.
void AddCalibrateCommand(CLI::App& app, int& exit_code);
void AddLensCommand(CLI::App& app, int& exit_code);

}  // namespace footing::camera
