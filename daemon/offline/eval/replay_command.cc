#include "daemon/offline/eval/replay_command.h"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "common/base/json_text.h"
#include "daemon/offline/eval/pose_replay.h"
#include "daemon/offline/eval/recorded.h"
#include "daemon/offline/eval/replay.h"
#include "daemon/simulation/gait_service/engine_files.h"
#include "daemon/simulation/gait_service/applied_input.h"

namespace footing::eval {
namespace {

struct Options {
  std::string file;
  std::string track;  ///< Empty: the recorded one.
  std::string data_folder;
};

/// The interface that the first recorded inputs name.
mapping::InterfaceOptions InterfaceOf(const std::vector<v1::Tick>& ticks) {
  for (const v1::Tick& tick : ticks) {
    if (tick.inputs().inputs_size() == 0) continue;
    return gait_service::FromAppliedInput(tick.inputs().inputs(0)).inputs.engine.interface.options;
  }
  return {};
}

Result<EngineReplay> ReplayEngine(const std::vector<v1::Tick>& ticks, const Options& options) {
  if (IsPoseRecording(ticks)) return ReplayPose(ticks, options.data_folder);
  const mapping::InterfaceOptions interface = InterfaceOf(ticks);
  engine_files::Wish wish{.interface = interface.interface, .data_folder = options.data_folder};
  const bool named_track = !options.track.empty();
  if (named_track) wish.track = options.track;
  const auto texts = engine_files::ReadTexts(wish);
  if (!texts) return texts.error();
  return ReplayBiped(ticks, {.texts = *texts,
                             .config = {.interface = interface},
                             .named_track = named_track,
                             .data_folder = options.data_folder});
}

int Run(const Options& options) {
  const std::string& path = options.file;
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
  EngineReplay engine;
  if (!recorded->simulation.empty()) {
    const auto replayed = ReplayEngine(recorded->simulation, options);
    if (!replayed) return cli::Report(replayed.error());
    engine = *replayed;
  }
  json["frames_compared"] = engine.frames;
  json["frames_equal"] = engine.equal;
  json["first_difference_step"] = engine.first_difference_step;
  json["last_step"] = engine.last_step;
  json["state_hash"] = std::to_string(engine.state_hash);
  std::cout << text::ToText(json) << std::endl;
  return features.equal == features.compared && engine.equal == engine.frames ? 0 : 1;
}

}  // namespace

void AddReplayCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("replay",
                                     "Replay of a recording through the same code; compares "
                                     "features and state hashes bit for bit");
  command->add_option("file", options->file, "Recording, MCAP file of footing-log")->required();
  command->add_option(
      "--track", options->track,
      "Track of the simulation in place of the recorded one: a name, or a JSON file");
  command->add_option("--data-folder", options->data_folder,
                      "Folder of the pose engine's models (default: the installed ones)");
  command->callback([options, &shared] { shared.exit_code = Run(*options); });
}

}  // namespace footing::eval
