#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "clients/ctl/connection.h"
#include "footing/v1/command.pb.h"

namespace footing::ctl {

/// Options and exit code common to all commands of footing-ctl.
struct Shared {
  std::string connect;  ///< footingd's address; empty: its default.
  bool json = false;
  int exit_code = 0;
};

/// A session with the address and defaults of the command line.
Result<std::unique_ptr<Connection>> Open(const Shared& shared,
                                         std::vector<std::string> channels = {"status", "setup"});

/// Prints the object with --json, else the text; always ends the line. Bad UTF-8 is replaced.
void Print(const nlohmann::ordered_json& out, const std::string& text, const Shared& shared);

/// Adds the server's remark on a command that it carried out, such as that the result is not
/// stored: to the person's text as "; REMARK", to `out` as "message". Adds nothing when there is
/// none.
void AddRemark(const v1::CommandResult& result, nlohmann::ordered_json& out, std::string& text);

/// Runs a command's body with an open session and keeps the exit code of what it returns.
void WithSession(Shared& shared, const std::vector<std::string>& channels,
                 const std::function<Result<void>(Connection&)>& body);

/// A session with footing-sim: at --connect, else at its default address. NoDevice, with how to
/// start it, when nothing listens there.
Result<std::unique_ptr<Connection>> OpenSimulation(const Shared& shared,
                                                   std::vector<std::string> channels,
                                                   const std::string& start_with);
/// Sends one command to footing-sim, likewise.
Result<void> SendToSimulation(const Shared& shared, v1::Command command,
                              const std::string& start_with);

/// Gives a device a role by hand, waits until the devices show it, and prints it.
Result<void> Assign(Connection& session, const std::string& device, const std::string& rig_role,
                    const Shared& shared);

void AddDeviceCommands(CLI::App& app, Shared& shared);     ///< devices, status, watch
void AddControlCommands(CLI::App& app, Shared& shared);    ///< rumble, led, tare
void AddAssignCommand(CLI::App& app, Shared& shared);      ///< assign
void AddDoctorCommand(CLI::App& app, Shared& shared);      ///< doctor
void AddPairCommand(CLI::App& app, Shared& shared);        ///< pair
void AddSetupCommand(CLI::App& app, Shared& shared);       ///< setup
void AddLayoutCommand(CLI::App& app, Shared& shared);      ///< layout
void AddAcceptanceCommand(CLI::App& app, Shared& shared);  ///< acceptance
void AddMotionsCommand(CLI::App& app, Shared& shared);     ///< motions
void AddPoseCommands(CLI::App& app, Shared& shared);       ///< t-pose, subject
void AddTrialCommands(CLI::App& app, Shared& shared);      ///< trial
void AddInterfaceCommand(CLI::App& app, Shared& shared);   ///< interface
void AddLeaseCommand(CLI::App& app, Shared& shared);       ///< lease
void AddSessionsCommand(CLI::App& app, Shared& shared);    ///< sessions
void AddMarkCommand(CLI::App& app, Shared& shared);        ///< mark
void AddSwayCommand(CLI::App& app, Shared& shared);        ///< sway
void AddTrustCommand(CLI::App& app, Shared& shared);       ///< trust
void AddConfigCommand(CLI::App& app, Shared& shared);      ///< config
void AddDiscoverCommand(CLI::App& app, Shared& shared);    ///< discover

}  // namespace footing::ctl
