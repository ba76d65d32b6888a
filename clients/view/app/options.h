#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/recording/recorded_session.h"
#include "common/transport/address.h"
#include "footing/v1/command.pb.h"

namespace footing::view {

/// What the command line asks for.
struct Options {
  std::vector<transport::Address> addresses;
  std::shared_ptr<const recording::RecordedSession> recording;  ///< In place of servers.
  std::string screenshot;                                       ///< A PNG file; empty for none.
  double at_s = 1;                         ///< When to take it, after connecting.
  std::string record_folder;               ///< For numbered PNG files; empty for none.
  double record_hz = 10;                   ///< Pictures a second.
  double seconds = 0;                      ///< Ends by itself; 0 runs on.
  bool subject = false;                    ///< The world without the panels.
  bool text = false;                       ///< In the terminal.
  bool json = false;                       ///< A summary at the end.
  bool replay_falls = false;               ///< Each fall again in slow motion.
  bool overlay_reference = false;          ///< The reference pose over the body, not beside it.
  std::vector<v1::Command> next_subjects;  ///< What the key N sends, one after the other.
  bool forces = false;                     ///< Force arrows from the start.
  int samples = 0;                         ///< Multisampling: 0, 2, 4, 8.
  int width = 1280;
  int height = 720;

  bool off_screen() const { return !screenshot.empty() || !record_folder.empty(); }
};

}  // namespace footing::view
