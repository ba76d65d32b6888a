#include "daemon/offline/eval/replay/replay_command.h"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "daemon/offline/eval/replay/recorded.h"
#include "daemon/offline/eval/replay/replay.h"
#include "daemon/simulation/engine_files/engine_files.h"

namespace footing::eval {
namespace {

Result<engine::GaitEngine> MakeEngine(const std::string& track) {
  const auto texts = engine_files::ReadTexts({.track = track});
  if (!texts) return texts.error();
  return engine::GaitEngine::Create(*texts);
}

int Run(const std::string& path, const std::string& track) {
  const auto recorded = ReadRecorded(path);
  if (!recorded) return cli::Report(recorded.error());
  if (recorded->sensor.empty() && recorded->simulation.empty()) {
    return cli::Report(InvalidData(path + " holds no ticks of footingd or footing-sim"));
  }
  nlohmann::ordered_json json;
  const FeaturesReplay features = ReplayFeatures(recorded->sensor);
  json["sensor_ticks"] = features.ticks;
  json["features_compared"] = features.compared;
  json["features_equal"] = features.equal;
  json["first_difference_sequence"] = features.first_difference_sequence;
  BipedReplay biped;
  if (!recorded->simulation.empty()) {
    auto engine = MakeEngine(track);
    if (!engine) return cli::Report(engine.error());
    const auto replayed = ReplayBiped(recorded->simulation, std::move(engine).value());
    if (!replayed) return cli::Report(replayed.error());
    biped = *replayed;
  }
  json["frames_compared"] = biped.frames;
  json["frames_equal"] = biped.equal;
  json["first_difference_step"] = biped.first_difference_step;
  json["last_step"] = biped.last_step;
  json["state_hash"] = std::to_string(biped.state_hash);
  std::cout << json.dump() << std::endl;
  return features.equal == features.compared && biped.equal == biped.frames ? 0 : 1;
}

}  // namespace

void AddReplayCommand(CLI::App& app, Shared& shared) {
  struct Options {
    std::string file;
    std::string track = "straight";
  };
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("replay",
                                     "Replay of a recording through the same code; compares "
                                     "features and state hashes bit for bit");
  command->add_option("file", options->file, "Recording, MCAP file of footing-log")->required();
  command->add_option("--track", options->track,
                      "Track of the recorded simulation: a name, or a JSON file");
  command->callback([options, &shared] { shared.exit_code = Run(options->file, options->track); });
}

}  // namespace footing::eval
