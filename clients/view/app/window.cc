#include "clients/view/app/window.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>
#include <utility>

#include "clients/view/app/feed.h"
#include "clients/view/app/glfw_window.h"
#include "clients/view/app/play_summary.h"
#include "clients/view/app/speaker.h"
#include "clients/view/render/screen.h"
#include "clients/view/scene/clear_view.h"
#include "clients/view/scene/model.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/frames/camera_file.h"
#include "common/runtime/clock.h"
#include "common/runtime/subject.h"
#include "common/wire/wire.h"

namespace footing::view {
namespace {

constexpr char kSimulation[] = "footing-sim", kSensorServer[] = "footingd";

/// Heights of the picture that an arrow key turns the view by.
constexpr double kTurnByKey = 0.03;
constexpr double kPushShownS = 0.3;

/// State that the callbacks of the window change.
struct LiveControls : WindowControls {
  std::string pressed;              ///< Capital letters of keys that the loop has yet to look at.
  int markers = 0;                  ///< Sent so far.
  std::optional<scene::Push> sent;  ///< The last push, while its arrow is shown.
  std::int64_t sent_ns = 0;
};

void TurnByKey(ViewMouse& mouse, int key) {
  if (key == GLFW_KEY_LEFT) mouse.Turn({-kTurnByKey, 0});
  if (key == GLFW_KEY_RIGHT) mouse.Turn({kTurnByKey, 0});
  if (key == GLFW_KEY_UP) mouse.Turn({0, -kTurnByKey});
  if (key == GLFW_KEY_DOWN) mouse.Turn({0, kTurnByKey});
  if (key == GLFW_KEY_EQUAL || key == GLFW_KEY_KP_ADD) mouse.ZoomView(1);
  if (key == GLFW_KEY_MINUS || key == GLFW_KEY_KP_SUBTRACT) mouse.ZoomView(-1);
}

void OnKey(GLFWwindow* window, int key, int, int action, int) {
  if (action != GLFW_PRESS && action != GLFW_REPEAT) return;
  auto& controls = static_cast<LiveControls&>(ControlsOf(window));
  TurnByKey(controls.mouse, key);
  if (action != GLFW_PRESS) return;
  render::HudOptions& hud = controls.hud;
  if (key >= GLFW_KEY_A && key <= GLFW_KEY_Z) {
    controls.pressed += static_cast<char>('A' + key - GLFW_KEY_A);
  }
  if (key == GLFW_KEY_P) hud.phases = !hud.phases;
  if (key == GLFW_KEY_R) hud.replay_asked = true;
  if (key == GLFW_KEY_C) hud.calibration_asked = true;
  if (key == GLFW_KEY_X) hud.calibration_end_asked = true;
  if (key == GLFW_KEY_V) hud.camera = !hud.camera;
  if (key == GLFW_KEY_SPACE) hud.frozen = !hud.frozen;
  OnSharedKey(window, key);
}

void Say(scene::Model& model, const std::string& text) {
  scene::Note note;
  note.text = text;
  note.received_ns = clock::MonotonicNs();
  model.last.note = note;
}

/// A marker from the key E.
void Mark(LiveControls& controls, Background& background, scene::Model& model) {
  const std::string server = scene::MarkedServer(model);
  if (server.empty()) {
    return Say(model,
               "Key E (a marker in the recordings): works only on the machine where a server runs, "
               "while it is connected.");
  }
  background.SendTo(server, MarkerCommand(++controls.markers));
}

/// The keys that send a command; a key that does nothing now says why.
void Answer(LiveControls& controls, const Options& options, Background& background,
            scene::Model& model, std::size_t& next_subject) {
  const scene::KeyContext context =
      scene::ContextOf(model, controls.hud.has_subjects, controls.hud.calibrates);
  for (const char key : std::exchange(controls.pressed, "")) {
    if (const std::string why = scene::WhyNoKey(key, context); !why.empty()) {
      Say(model, why);
    } else if (key == 'E') {
      Mark(controls, background, model);
    } else if (key == 'T') {
      background.SendTo(kSimulation, TPoseCommand());
    } else if (scene::ChangesMode(key)) {
      const auto& characters = model.playout.Newest().characters;
      background.SendTo(kSimulation, ModeCommand(key, *characters.front().body));
    } else if (key == 'N') {
      background.SendTo(kSimulation, options.next_subjects[next_subject++]);
      next_subject %= options.next_subjects.size();
    }
  }
}

/// Key presses that belong to the calibration.
void Calibrate(render::HudOptions& hud, std::optional<PoseCalibration>& calibration,
               scene::Model& model) {
  if (std::exchange(hud.calibration_end_asked, false) && calibration) calibration->End();
  if (!std::exchange(hud.calibration_asked, false)) return;
  if (calibration) {
    hud.camera = true;  // Whoever holds a sphere must see whether the camera does.
    return calibration->Begin();
  }
  Say(model, "Start footing-view with --calibrate-camera FILE, the camera's file.");
}

/// Sends a push that was released, and draws the arrow of the present or the last one.
void Push(LiveControls& controls, Background& background, scene::Show::Shot& shot,
          std::int64_t now_ns) {
  if (const auto push = std::exchange(controls.pushed, std::nullopt)) {
    background.SendTo(kSimulation, PushCommand(*push));
    controls.sent = push;
    controls.sent_ns = now_ns;
  }
  if (NanosecondsToSeconds(now_ns - controls.sent_ns) > kPushShownS) controls.sent.reset();
  const auto shown = controls.mouse.push() ? controls.mouse.push() : controls.sent;
  if (shown) scene::AddPush(shot.frame, *shown, shot.picture);
}

void Rumble(const std::vector<scene::Sound>& sounds, const scene::WorldFrame& frame,
            Background& background, const scene::Model& model) {
  for (v1::Command& command : RumbleCommands(sounds, frame, model))
    background.SendTo(kSensorServer, std::move(command));
}

bool MayPush(const Options& options, const LiveControls& controls, const scene::Model& model) {
  const scene::KeyContext context = scene::ContextOf(model, false, false);
  return !options.subject && !controls.hud.frozen && !model.observed.calibration &&
         scene::WhyNoPush(context).empty();
}

Result<std::optional<PlaySession>> Loop(GLFWwindow* window, const Options& options,
                                        render::Screen& screen, LiveControls& controls,
                                        std::optional<PoseCalibration>& calibration) {
  render::HudOptions& hud = controls.hud;
  Background background(options);
  scene::Show show;
  PictureTimes times;
  ViewSounds sounds(options.feedback.sound);
  if (options.replay_falls) show.ReplayFalls();
  const std::int64_t started_ns = clock::MonotonicNs();
  double passed_s = 0;
  std::size_t next_subject = 0;
  while (glfwWindowShouldClose(window) == GLFW_FALSE && !background.stop_asked() &&
         (options.seconds <= 0 || passed_s < options.seconds)) {
    glfwPollEvents();
    if (auto dropped = TakeDropped(options, controls)) return dropped;
    background.WantPreview(hud.camera || hud.camera_alone);
    Calibrate(hud, calibration, show.model());
    background.Drain(show, calibration ? &*calibration : nullptr);
    const std::int64_t now_ns = clock::MonotonicNs();
    if (std::exchange(hud.replay_asked, false)) show.ToggleReplay(now_ns);
    Answer(controls, options, background, show.model(), next_subject);
    auto shot =
        show.At(now_ns, hud.frozen, {hud.forces, hud.overlay_reference, controls.mouse.followed()});
    shot.picture.camera =
        scene::ClearView(shot.picture, show.model().track, controls.mouse.orbit());
    Push(controls, background, shot, now_ns);
    screen.set_display_scale(DisplayScale(window));
    controls.Refresh(window);
    const PixelSize size = BeginPicture(window);
    const render::HudContent content{shot.picture, show.model(), shot.frame,
                                     now_ns,       shot.past,    shot.past_ns};
    screen.Draw(content, hud, size.width, size.height);
    const render::Box whole{{0, 0},
                            {static_cast<float>(size.width), static_cast<float>(size.height)}};
    const DrawnView view = ViewOf(screen, content, hud, whole);
    const std::vector<scene::Sound> heard = sounds.Follow({view});
    if (options.feedback.rumble) Rumble(heard, shot.frame, background, show.model());
    controls.mouse.SetViews({view}, MayPush(options, controls, show.model()));
    EndPicture(window, now_ns, times);
    passed_s = NanosecondsToSeconds(clock::MonotonicNs() - started_ns);
  }
  if (options.json) std::cout << Summary(show.model(), passed_s, times) << std::endl;
  return std::optional<PlaySession>();
}

/// The live view, as PlayInWindow.
Result<std::optional<PlaySession>> ShowLive(GLFWwindow* window, const Options& options) {
  auto screen = render::Screen::Create();
  if (!screen) return screen.error();
  auto calibration = PoseCalibration::OfOptions(options.camera.calibration_file);
  if (!calibration) return calibration.error();
  (*screen)->set_ui_scale(static_cast<float>(options.look.ui_scale));
  LiveControls controls;
  render::HudOptions& hud = controls.hud;
  hud.hidden = options.subject;
  hud.forces = options.forces;
  hud.overlay_reference = options.overlay_reference;
  hud.camera = options.camera.corner || *calibration;
  hud.camera_alone = options.camera.alone;
  hud.panels = options.look.panels;
  hud.has_subjects = !options.next_subjects.empty();
  hud.calibrates = calibration->has_value();
  controls.mouse.SetView(options.look.orbit);
  Listen(window, controls, OnKey);
  return Loop(window, options, **screen, controls, *calibration);
}

}  // namespace

bool HasDisplay() {
  const char* display = std::getenv("DISPLAY");
  return display != nullptr && *display != '\0';
}

Result<void> RunWindow(const Options& options, std::optional<PlaySession> played) {
  const GlfwLibrary library;
  const auto opened = OpenWindow(library, options);
  if (!opened) return opened.error();
  const std::int64_t started_ns = clock::MonotonicNs();
  Options left = options;
  for (;;) {
    auto next = played ? PlayInWindow(opened->get(), left, *played) : ShowLive(opened->get(), left);
    if (!next) return next.error();
    if (!*next) return {};
    played.emplace(std::move(**next));
    if (options.seconds <= 0) continue;
    const double passed_s = NanosecondsToSeconds(clock::MonotonicNs() - started_ns);
    left.seconds = std::max(1e-3, options.seconds - passed_s);
  }
}

namespace {

v1::Command RecordCommand(const std::string& rig, stream::SetupItem item) {
  item.wall_time_ns = clock::WallNs();
  v1::Command command;
  command.mutable_record_setup()->set_rig(rig);
  *command.mutable_record_setup()->mutable_item() = wire::ToProto(item);
  return command;
}

}  // namespace

Result<PoseCalibration> PoseCalibration::Open(const std::string& camera_file) {
  const auto camera = frames::ReadCameraFile(camera_file);
  if (!camera) return camera.error();
  guide::SetUpOptions options;
  options.camera_file = camera_file;
  options.camera_role = camera->spheres.front().role;
  options.camera_radius_m = camera->spheres.front().target.radius_m;
  options.tries = 1;  // A refusal is read first; then the person begins again.
  return PoseCalibration(std::move(options));
}

Result<std::optional<PoseCalibration>> PoseCalibration::OfOptions(const std::string& camera_file) {
  if (camera_file.empty()) return std::optional<PoseCalibration>();
  auto opened = Open(camera_file);
  if (!opened) return opened.error();
  opened->Begin();
  return std::optional<PoseCalibration>(std::move(opened).value());
}

void PoseCalibration::Begin() {
  set_up_.emplace(options_, std::vector<guide::Item>{guide::Item::kCamera});
  answers_.clear();
  shown_ = {};
  shown_.rig = options_.rig;
  shown_.file = options_.camera_file;
}

void PoseCalibration::End() { set_up_.reset(); }

void PoseCalibration::Take(const scene::Update& update) {
  if (update.host_ns != 0) now_ns_ = update.host_ns;
  recent_.Take(update);
}

guide::Answer PoseCalibration::Store(const guide::Action& action) const {
  constexpr std::size_t kDateLength = 10;  // Length of an ISO 8601 date.
  const std::string date = text::Utc(clock::WallNs()).substr(0, kDateLength);
  const auto stored =
      frames::StorePose(options_.camera_file, action.X_WC, date + ": " + action.remark);
  guide::Answer answer;
  answer.key = action.key;
  answer.ok = stored.ok();
  answer.message =
      stored ? action.remark + "; stored in " + options_.camera_file : stored.error().message;
  return answer;
}

void PoseCalibration::TakeProgress(guide::Progress progress) {
  shown_.prompt = std::move(progress.prompt);
  shown_.feedback = std::move(progress.feedback);
  if (progress.marks) shown_.marks = std::move(progress.marks);
  for (const guide::Action& action : progress.actions)
    if (action.kind == guide::Action::Kind::kStoreCamera) answers_.push_back(Store(action));
}

void PoseCalibration::Advance(scene::Model& model, const std::function<void(v1::Command)>& record) {
  if (!set_up_) {
    model.observed.calibration.reset();
    return;
  }
  // Without a newer tick nothing can have happened.
  if (!shown_.result && now_ns_ != std::exchange(advanced_ns_, now_ns_)) {
    guide::Situation now;
    now.now_ns = now_ns_;
    now.recent = &recent_;
    now.setup = &model.setup;
    now.answers = std::exchange(answers_, {});
    guide::Progress progress = set_up_->Advance(now);
    TakeProgress(std::move(progress));
    if (!set_up_->results().empty()) {
      shown_.result = set_up_->results().back();
      record(RecordCommand(options_.rig, *shown_.result));
    }
  }
  model.observed.calibration = shown_;
}

Result<std::vector<v1::Command>> SubjectCommands(const std::vector<std::string>& files) {
  std::vector<v1::Command> commands;
  for (const std::string& file : files) {
    const auto subject = subject::ReadSubject(file);
    if (!subject) return subject.error();
    v1::SetSubject& set = *commands.emplace_back().mutable_set_subject();
    set.set_code(subject->code);
    set.set_height_m(subject->height_m);
    set.set_mass_kg(subject->mass_kg);
    set.set_foot_length_m(subject->foot_length_m);
  }
  return commands;
}

v1::Command TPoseCommand() {
  v1::Command command;
  command.mutable_calibrate_t_pose()->set_character(1);
  return command;
}

namespace {

/// The motor of a Wiimote needs some 30 ms to be felt.
constexpr double kShortestRumbleMs = 40, kMoreRumbleMs = 80;
constexpr double kHardMps = 3;  // A jump's landing.

const scene::CharacterPose* BipedOf(const scene::WorldFrame& frame, std::uint32_t character) {
  for (const scene::CharacterPose& pose : frame.characters) {
    if (pose.character == character && !pose.body) return &pose;
  }
  return nullptr;
}

}  // namespace

std::vector<v1::Command> RumbleCommands(const std::vector<scene::Sound>& sounds,
                                        const scene::WorldFrame& frame, const scene::Model& model) {
  std::vector<v1::Command> commands;
  for (const scene::Sound& sound : sounds) {
    const scene::CharacterPose* pose = BipedOf(frame, sound.character);
    if (sound.foot < 0 || sound.foot > 1 || pose == nullptr) continue;
    const auto role =
        sound.foot == 0 ? stream::DeviceRole::kLeftHand : stream::DeviceRole::kRightHand;
    const double hardness = std::clamp(sound.impact_mps / kHardMps, 0.0, 1.0);
    for (const scene::Device& device : model.devices) {
      if (device.status.rig != pose->rig || device.status.role != role) continue;
      v1::SetRumble& rumble = *commands.emplace_back().mutable_set_rumble();
      rumble.set_device(device.status.device);
      rumble.set_on(true);
      rumble.set_lease_ms(static_cast<std::uint32_t>(kShortestRumbleMs + hardness * kMoreRumbleMs));
    }
  }
  return commands;
}

v1::Command PushCommand(const scene::Push& push) {
  v1::Command command;
  command.mutable_push()->set_character(push.character);
  command.mutable_push()->set_impulse_x_ns(push.impulse_W_ns.x());
  command.mutable_push()->set_impulse_y_ns(push.impulse_W_ns.y());
  return command;
}

v1::Command MarkerCommand(int number) {
  v1::Command command;
  command.mutable_marker()->set_text("viewer mark " + std::to_string(number));
  // The key works on this machine only, where the server has the same clock.
  command.mutable_marker()->set_host_ns(clock::MonotonicNs());
  return command;
}

v1::Command ModeCommand(char key, const scene::BodyState& body) {
  v1::Command command;
  v1::SetPoseMode& set = *command.mutable_set_pose_mode();
  set.set_character(1);
  const bool other = key == 'M';
  set.set_mode((body.mode == "paper") != other ? "paper" : "best");
  const std::string part = scene::PartOfKey(key);
  for (const std::string& left_out : body.left_out) {
    if (left_out != part) set.add_left_out(left_out);
  }
  const bool was_left_out =
      std::find(body.left_out.begin(), body.left_out.end(), part) != body.left_out.end();
  if (!part.empty() && !was_left_out) set.add_left_out(part);
  return command;
}

}  // namespace footing::view
