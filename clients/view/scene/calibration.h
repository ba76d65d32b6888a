#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "clients/view/scene/camera.h"
#include "clients/view/scene/part.h"
#include "common/guide/marks_state.h"
#include "common/stream/setup.h"

namespace footing::scene {

struct Model;
struct Picture;

/// The guided calibration of where the camera stands, as its screen shows it.
struct Calibration {
  std::string rig;
  std::string file;      ///< The camera file that the pose is written to.
  std::string prompt;    ///< To the person; empty once there is a result.
  std::string feedback;  ///< What is seen at the moment.
  std::optional<guide::MarksState> marks;
  std::optional<stream::SetupItem> result;
};

/// The boards from the person's side with the marks on them: those that are done green, the next
/// one amber and pulsing, with the controller above it where it has to stand; at the end the
/// residual of each mark, and the camera where it stands.
void AddCalibration(const Model& model, std::int64_t now_ns, Picture& picture);

/// The prompt, or how it ended.
std::string CalibrationTitle(const Calibration& calibration);
/// What is seen, or cause and remedy of a refusal.
std::string CalibrationDetail(const Calibration& calibration);
/// "Camera's pose, mark 3 of 10".
std::string CalibrationProgress(const Calibration& calibration);

}  // namespace footing::scene
