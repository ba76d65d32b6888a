#include "clients/view/app/window.h"

#include <cstdlib>
#include <iostream>
#include <optional>
#include <utility>

#include "clients/view/app/background.h"
#include "clients/view/app/glfw_window.h"
#include "clients/view/app/pose_calibration.h"
#include "clients/view/app/subjects.h"
#include "clients/view/app/summary.h"
#include "clients/view/render/screen.h"
#include "common/clock/clock.h"
#include "common/units/units.h"

namespace footing::view {
namespace {

constexpr char kSimulation[] = "footing-sim";

void OnKey(GLFWwindow* window, int key, int, int action, int) {
  if (action != GLFW_PRESS) return;
  auto& hud = *static_cast<render::HudOptions*>(glfwGetWindowUserPointer(window));
  if (key == GLFW_KEY_F) hud.forces = !hud.forces;
  if (key == GLFW_KEY_P) hud.phases = !hud.phases;
  if (key == GLFW_KEY_T) hud.t_pose_asked = true;
  if (key == GLFW_KEY_N) hud.next_subject_asked = true;
  if (key == GLFW_KEY_O) hud.overlay_reference = !hud.overlay_reference;
  if (key == GLFW_KEY_R) hud.replay_asked = true;
  if (key == GLFW_KEY_C) hud.calibration_asked = true;
  if (key == GLFW_KEY_X) hud.calibration_end_asked = true;
  if (key == GLFW_KEY_V) hud.camera = !hud.camera;
  if (key == GLFW_KEY_SPACE) hud.frozen = !hud.frozen;
  if (key == GLFW_KEY_ESCAPE || key == GLFW_KEY_Q) glfwSetWindowShouldClose(window, GLFW_TRUE);
}

// The question mark is a letter, on whichever key the layout has it.
void OnLetter(GLFWwindow* window, unsigned int letter) {
  auto& hud = *static_cast<render::HudOptions*>(glfwGetWindowUserPointer(window));
  if (letter == '?') hud.keys = !hud.keys;
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
  scene::Note note;
  note.text = "Start footing-view with --calibrate-camera FILE, the camera's file.";
  note.received_ns = clock::MonotonicNs();
  model.last.note = note;
}

void Loop(GLFWwindow* window, const Options& options, render::Screen& screen,
          render::HudOptions& hud, std::optional<PoseCalibration>& calibration) {
  Background background(options);
  scene::Show show;
  if (options.replay_falls) show.ReplayFalls();
  const std::int64_t started_ns = clock::MonotonicNs();
  double passed_s = 0;
  std::size_t next_subject = 0;
  while (glfwWindowShouldClose(window) == GLFW_FALSE && !background.stop_asked() &&
         (options.seconds <= 0 || passed_s < options.seconds)) {
    glfwPollEvents();
    background.WantPreview(hud.camera || hud.camera_alone);
    Calibrate(hud, calibration, show.model());
    background.Drain(show, calibration ? &*calibration : nullptr);
    const std::int64_t now_ns = clock::MonotonicNs();
    if (std::exchange(hud.replay_asked, false)) show.ToggleReplay(now_ns);
    if (std::exchange(hud.t_pose_asked, false)) background.SendTo(kSimulation, TPoseCommand());
    if (std::exchange(hud.next_subject_asked, false) && !options.next_subjects.empty()) {
      background.SendTo(kSimulation, options.next_subjects[next_subject++]);
      next_subject %= options.next_subjects.size();
    }
    const auto shot = show.At(now_ns, hud.frozen, {hud.forces, hud.overlay_reference});
    screen.set_display_scale(DisplayScale(window));
    const PixelSize size = BeginPicture(window);
    screen.Draw({shot.picture, show.model(), shot.frame, now_ns, shot.past, shot.past_ns}, hud,
                size.width, size.height);
    EndPicture(window, now_ns);
    passed_s = NanosecondsToSeconds(clock::MonotonicNs() - started_ns);
  }
  if (options.json) std::cout << Summary(show.model(), passed_s) << std::endl;
}

}  // namespace

bool HasDisplay() {
  const char* display = std::getenv("DISPLAY");
  return display != nullptr && *display != '\0';
}

Result<void> RunWindow(const Options& options) {
  const GlfwLibrary library;
  const auto opened = OpenWindow(library, options);
  if (!opened) return opened.error();
  GLFWwindow* const window = opened->get();
  auto screen = render::Screen::Create();
  if (!screen) return screen.error();
  auto calibration = PoseCalibration::OfOptions(options.camera.calibration_file);
  if (!calibration) return calibration.error();
  render::HudOptions hud;
  hud.hidden = options.subject;
  hud.forces = options.forces;
  hud.overlay_reference = options.overlay_reference;
  hud.camera = options.camera.corner || *calibration;
  hud.camera_alone = options.camera.alone;
  glfwSetWindowUserPointer(window, &hud);
  glfwSetKeyCallback(window, OnKey);
  glfwSetCharCallback(window, OnLetter);
  Loop(window, options, **screen, hud, *calibration);
  return {};
}

}  // namespace footing::view
