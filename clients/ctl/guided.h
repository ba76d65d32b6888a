#pragma once

#include <string>
#include <vector>

#include "clients/ctl/commands.h"
#include "common/guide/camera_step.h"
#include "common/guide/recent.h"
#include "common/recording/recording_writer.h"
#include "common/stream/setup.h"

namespace footing::ctl {

/// How prompts reach the person, or the script that drives devices in a person's place.
struct PromptOptions {
  bool script = false;  ///< Lines "PROMPT: ..." and "DONE: ..." only, and nobody presses Enter.
};

/// Whether Enter was pressed on the terminal since the last call; never where there is none.
bool EnterPressed();

/// The channels that a guided command needs.
const std::vector<std::string>& GuidedChannels();

/// The recording of a guided command: compressed, and stamped with this program's version.
Result<recording::RecordingWriter> CreateRecording(const std::string& path, bool replace);

/// Attached devices of a rig.
std::vector<stream::DeviceStatus> DevicesOf(const Connection& session, const std::string& rig);

/// Runs items of the set-up with footingd and the person, and records each result there. What was
/// found is returned with its date; Failure when it was interrupted or footingd went away.
Result<std::vector<stream::SetupItem>> RunGuided(Connection& session,
                                                 const guide::SetUpOptions& options,
                                                 const std::vector<guide::Item>& items,
                                                 const PromptOptions& prompts);

/// The rig's items as footingd keeps them, with `results` on top.
std::vector<stream::SetupItem> ItemsOf(const Connection& session, const std::string& rig,
                                       const std::vector<stream::SetupItem>& results);

/// {name, serial, passed, residual, unit, date, stale, note}
nlohmann::ordered_json ToJson(const stream::SetupItem& item);
/// One line a person.
std::string ToText(const stream::SetupItem& item);

/// Prints {rig, items, ready, missing}; a failure when the set-up is not ready.
Result<void> PrintItems(const Connection& session, const std::string& rig,
                        const std::vector<stream::SetupItem>& items, bool need_ready,
                        const Shared& shared);

/// Roles of --worn. UsageError for an unknown role, a board's role, or one that comes twice.
Result<std::vector<stream::DeviceRole>> BodyRoles(const std::vector<std::string>& names);

/// `assign --gesture`: "Step on the left board now.", "Shake the left wrist now." The session needs
/// GuidedChannels().
Result<void> AssignByGesture(Connection& session, const std::string& rig,
                             const std::vector<stream::DeviceRole>& body_roles, bool script,
                             const Shared& shared);

}  // namespace footing::ctl
