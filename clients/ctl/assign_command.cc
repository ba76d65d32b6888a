#include <memory>

#include "clients/ctl/commands.h"
#include "clients/ctl/report/find_device.h"
#include "clients/ctl/gesture_command.h"
#include "clients/ctl/guided.h"
#include "common/cli/cli.h"

namespace footing::ctl {

void AddAssignCommand(CLI::App& app, Shared& shared) {
  struct Arguments {
    std::string device, rig_role;
    std::string rig = "main";
    std::vector<std::string> body_roles;
    bool gesture = false;
    bool script = false;
  };
  const auto given = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("assign", "Assign a device to a rig and a role");
  command->add_option("DEVICE", given->device, "Serial, number, RIG/ROLE or ROLE");
  command->add_option("ROLE", given->rig_role, "RIG/ROLE, or ROLE in the default rig");
  command->add_flag("--gesture", given->gesture,
                    "Identify devices by stepping on boards and shaking remotes");
  command->add_option("--rig", given->rig, "Rig of --gesture (default main)");
  command
      ->add_option("--worn", given->body_roles,
                   "Roles of the remotes for --gesture, such as left_leg,right_leg")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_flag("--script", given->script,
                    "Print the prompts of --gesture as lines PROMPT: ...");
  command->footer(
      "A role that is taken is swapped with the device's own.\n"
      "Example:\n  footing-ctl assign 00:1f:32:aa:bb:cc main/left_hand\n"
      "  footing-ctl assign --gesture --worn left_leg,right_leg");
  command->callback([given, &shared] {
    if (given->gesture) {
      const auto roles = BodyRoles(given->body_roles);
      if (!roles) {
        shared.exit_code = cli::Report(roles.error());
        return;
      }
      WithSession(shared, GuidedChannels(), [&](Session& session) {
        return AssignByGesture(session, given->rig, *roles, given->script, shared);
      });
      return;
    }
    if (given->device.empty() || given->rig_role.empty()) {
      shared.exit_code = cli::Report(
          UsageError("assign takes DEVICE and ROLE, or --gesture; see footing-ctl assign --help"));
      return;
    }
    if (const auto role = display::ParseRigRole(given->rig_role); !role) {
      shared.exit_code = cli::Report(role.error());
      return;
    }
    WithSession(shared, {"status"}, [&](Session& session) {
      return Assign(session, given->device, given->rig_role, shared);
    });
  });
}

}  // namespace footing::ctl
