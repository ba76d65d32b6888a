#pragma once

#include <optional>
#include <string>
#include <vector>

#include "clients/view/render/hud.h"
#include "clients/view/scene/camera.h"
#include "clients/view/scene/timeline.h"
#include "common/net/address.h"
#include "footing/v1/command.pb.h"

namespace footing::view {

/// Options of playback, which takes the place of servers.
struct PlayOptions {
  std::string recording;         ///< A file; empty: servers are shown.
  std::string trial;             ///< Only this one; empty: all.
  std::string beside;            ///< FILE or FILE:TRIAL to compare with; empty: none.
  double speed = 1;              ///< Recorded seconds a second.
  std::optional<double> from_s;  ///< Position to begin at; nothing: the beginning.
  timeline::Alignment alignment = timeline::Alignment::kStart;
};

/// Options for the picture of footing-camera.
struct CameraOptions {
  transport::Address address;    ///< Address of its preview, a Unix socket.
  bool corner = false;           ///< The preview in a corner, from the start.
  bool alone = false;            ///< Shows the preview and nothing else.
  std::string calibration_file;  ///< The camera file whose pose is calibrated; empty: none is.
};

/// How the panels look.
struct LookOptions {
  double ui_scale = 1;         ///< Their size over the usual one.
  render::PanelChoice panels;  ///< Panels shown at both sides.
  bool timeline = true;        ///< Under a recording that is played.
  scene::Orbit orbit;          ///< View to begin with.
};

/// Ways to hear and to feel the steps.
struct FeedbackOptions {
  bool sound = false;   ///< Steps, landings and wings are heard.
  bool rumble = false;  ///< The remotes shake at touchdowns.
};

/// Options from the command line.
struct Options {
  std::vector<transport::Address> addresses;
  PlayOptions play;
  std::string screenshot;                  ///< A PNG or JPEG file; empty for none.
  std::optional<double> at_s;              ///< When to take it, after connecting, or the position.
  std::string record;                      ///< A folder for numbered PNG files, or a film.
  double record_hz = 10;                   ///< Pictures a second.
  double seconds = 0;                      ///< Ends by itself; 0 runs on.
  bool subject = false;                    ///< The world without the panels.
  bool text = false;                       ///< Text in the terminal.
  bool json = false;                       ///< A summary at the end.
  bool replay_falls = false;               ///< Each fall again in slow motion.
  bool overlay_reference = false;          ///< The reference pose over the body, not beside it.
  std::vector<v1::Command> next_subjects;  ///< Commands that the key N sends, one after the other.
  bool forces = false;                     ///< Force arrows from the start.
  CameraOptions camera;
  /// Samples per pixel: 0, 2, 4, 8; nothing: as many as render::Target chooses.
  std::optional<int> samples;
  LookOptions look;
  FeedbackOptions feedback;
  int width = 1280;
  int height = 720;

  bool off_screen() const { return !screenshot.empty() || !record.empty(); }
};

}  // namespace footing::view
