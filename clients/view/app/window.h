#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "clients/view/app/options.h"
#include "clients/view/app/play_session.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/pointer.h"
#include "clients/view/scene/sound.h"
#include "clients/view/scene/update.h"
#include "common/base/result.h"
#include "common/guide/set_up.h"
#include "footing/v1/command.pb.h"

namespace footing::view {

/// True when there is a display to open a window on.
bool HasDisplay();

/// The window, until it is closed, Ctrl-C or options.seconds: live, or of what is `played`; a
/// recording that is dropped on it plays from then on. Fails at once, before anything is shown,
/// when no window can be opened.
Result<void> RunWindow(const Options& options, std::optional<PlaySession> played);

/// The item "camera" of the guided setup on the viewer's screen: the same steps as those of
/// footing-ctl setup --only camera. The pose goes into the camera file, the result to footingd.
class PoseCalibration {
 public:
  /// The sphere is the first one of the file.
  static Result<PoseCalibration> Open(const std::string& camera_file);

  /// The one that the options ask for, begun; nothing where they do not.
  static Result<std::optional<PoseCalibration>> OfOptions(const std::string& camera_file);

  /// Starts at the first mark.
  void Begin();
  /// Closes its screen; nothing is stored.
  void End();

  /// A tick of footingd's.
  void Take(const scene::Update& update);
  /// Goes on with what came since the last call, and puts what is to be seen into the model.
  /// `record` gets the result, for footingd.
  void Advance(scene::Model& model, const std::function<void(v1::Command)>& record);

 private:
  explicit PoseCalibration(guide::SetUpOptions options) : options_(std::move(options)) {}
  void TakeProgress(guide::Progress progress);
  guide::Answer Store(const guide::Action& action) const;

  guide::SetUpOptions options_;
  std::optional<guide::SetUp> set_up_;
  guide::Recent recent_;
  std::vector<guide::Answer> answers_;
  std::int64_t now_ns_ = 0, advanced_ns_ = 0;  ///< footingd's clock.
  scene::Calibration shown_;
};

/// The commands that put each subject file in place, in their order.
Result<std::vector<v1::Command>> SubjectCommands(const std::vector<std::string>& files);

/// Forgets the T-pose of the first character.
v1::Command TPoseCommand();
/// The push on a character.
v1::Command PushCommand(const scene::Push& push);
/// Motors that shake at touchdowns: of the remote in the hand on the foot's side, for the longer
/// the harder it was. Nothing for a person's own feet.
std::vector<v1::Command> RumbleCommands(const std::vector<scene::Sound>& sounds,
                                        const scene::WorldFrame& frame, const scene::Model& model);
/// A marker of the person at the viewer, now; `number` counts them.
v1::Command MarkerCommand(int number);
/// The other mode, or the mode with or without a part, as the key has it (M, L, U, B, K).
v1::Command ModeCommand(char key, const scene::BodyState& body);

}  // namespace footing::view
