#include <memory>

#include "clients/ctl/commands.h"

namespace footing::ctl {

void AddAssignCommand(CLI::App& app, Shared& shared) {
  struct Words {
    std::string device, rig_role;
  };
  const auto words = std::make_shared<Words>();
  CLI::App* command = app.add_subcommand("assign", "Say what a device is: its rig and role");
  command->add_option("DEVICE", words->device, "Serial, number, RIG/ROLE or ROLE")->required();
  command->add_option("ROLE", words->rig_role, "RIG/ROLE, or ROLE in the default rig")->required();
  command->footer(
      "A role that is taken is swapped with the device's own.\n"
      "Example:\n  footing-ctl assign 00:1f:32:aa:bb:cc main/left_hand");
  command->callback([words, &shared] {
    WithSession(shared, {"status"}, [&](Session& session) {
      return Assign(session, words->device, words->rig_role, shared);
    });
  });
}

}  // namespace footing::ctl
