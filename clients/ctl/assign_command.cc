#include <memory>

#include "clients/ctl/commands.h"
#include "clients/ctl/gesture_command.h"
#include "clients/ctl/guided.h"
#include "clients/ctl/words/find_device.h"
#include "common/cli/cli.h"

namespace footing::ctl {

void AddAssignCommand(CLI::App& app, Shared& shared) {
  struct Words {
    std::string device, rig_role;
    std::string rig = "main";
    std::vector<std::string> worn;
    bool gesture = false;
    bool script = false;
  };
  const auto given = std::make_shared<Words>();
  CLI::App* command = app.add_subcommand("assign", "Say what a device is: its rig and role");
  command->add_option("DEVICE", given->device, "Serial, number, RIG/ROLE or ROLE");
  command->add_option("ROLE", given->rig_role, "RIG/ROLE, or ROLE in the default rig");
  command->add_flag("--gesture", given->gesture,
                    "Find out by stepping on boards and shaking devices");
  command->add_option("--rig", given->rig, "The rig of --gesture");
  command
      ->add_option("--worn", given->worn, "What the remotes of --gesture are: left_leg,right_leg")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_flag("--script", given->script, "Prompts of --gesture as lines PROMPT: ...");
  command->footer(
      "A role that is taken is swapped with the device's own.\n"
      "Example:\n  footing-ctl assign 00:1f:32:aa:bb:cc main/left_hand\n"
      "  footing-ctl assign --gesture --worn left_leg,right_leg");
  command->callback([given, &shared] {
    if (given->gesture) {
      const auto worn = WornRoles(given->worn);
      if (!worn) {
        shared.exit_code = cli::Report(worn.error());
        return;
      }
      WithSession(shared, GuidedChannels(), [&](Session& session) {
        return AssignByGesture(session, given->rig, *worn, given->script, shared);
      });
      return;
    }
    if (given->device.empty() || given->rig_role.empty()) {
      shared.exit_code = cli::Report(
          UsageError("assign takes DEVICE and ROLE, or --gesture; see footing-ctl assign --help"));
      return;
    }
    if (const auto role = words::ParseRigRole(given->rig_role); !role) {
      shared.exit_code = cli::Report(role.error());
      return;
    }
    WithSession(shared, {"status"}, [&](Session& session) {
      return Assign(session, given->device, given->rig_role, shared);
    });
  });
}

}  // namespace footing::ctl
