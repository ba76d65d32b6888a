#include "clients/stream/rehearse_command.h"

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

namespace footing::stream_client {

CLI::App* AddRehearseCommand(CLI::App& app, RehearseOptions& options) {
  SetupPersonOptions& person = options.person;
  auto* rehearse = app.add_subcommand(
      "rehearse", "A synthetic person who performs what footing-ctl setup asks for");
  rehearse->add_option("--interface", person.interface,
                       "Interface whose devices the person uses: wrist, arm, leg, joystick or "
                       "boards (default: two held remotes and two boards)");
  rehearse
      ->add_option("--boards", person.boards, "Number of boards (default: those of the interface)")
      ->check(CLI::Range(0, 2));
  rehearse->add_option("--mass-kg", person.mass_kg, "Mass of the person, kg (default 70)")
      ->check(CLI::Range(20.0, 200.0));
  rehearse->add_option("--rig", person.rig, "Rig whose setup is followed (default main)");
  rehearse->add_flag("--strapped", person.strapped,
                     "Strap the remotes of wrist and arm on the wrists, askew, instead of holding "
                     "them; for footing-ctl setup --worn left_hand,right_hand");
  rehearse->add_flag("--jumbled", person.jumbled,
                     "Let left and right devices ask for each other's roles");
  rehearse->add_flag("--once", person.once, "End after one setup");
  rehearse->add_option("--watch", options.sensor,
                       "Address of footingd, whose setup is followed, unix:PATH, tcp:HOST:PORT or "
                       "tls:HOST:PORT");
  rehearse->add_flag("--json", options.json,
                     "At the end print what was asked for and performed, as JSON");
  return rehearse;
}

void PrintAsked(const SetupRecord& record, bool json) {
  const auto& asked = record.asked;
  const auto performed =
      std::count_if(asked.begin(), asked.end(), [](const auto& one) { return one.performed; });
  if (!json) {
    std::cerr << "setups: " << record.setups << ", prompts: " << asked.size()
              << ", performed: " << performed << std::endl;
    return;
  }
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const SetupRecord::Asked& one : asked) {
    const bool has_role = one.prompt.role != stream::DeviceRole::kUnspecified;
    rows.push_back({{"item", one.prompt.item},
                    {"gesture", stream::Name(one.prompt.gesture)},
                    {"role", has_role ? stream::Name(one.prompt.role) : ""},
                    {"prompt", one.prompt.text},
                    {"performed", one.performed}});
  }
  std::cout << nlohmann::ordered_json{{"setups", record.setups},
                                      {"prompts", asked.size()},
                                      {"performed", performed},
                                      {"rows", rows}}
            << std::endl;
}

}  // namespace footing::stream_client
