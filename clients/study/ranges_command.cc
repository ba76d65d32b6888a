#include <memory>
#include <optional>
#include <utility>

#include "clients/study/commands.h"
#include "clients/study/session/study_folder.h"
#include "clients/study/session/range_feed.h"
#include "clients/study/session/measure_ranges.h"
#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/runtime/data_file.h"
#include "common/recording/output_file.h"
#include "common/stream/leg_turn.h"
#include "common/stream/user_interface.h"
#include "common/base/number.h"
#include "common/base/utc.h"
#include "common/net/address_or_default.h"

namespace footing::study {
namespace {

struct RangesOptions {
  ranges::Played played;
  std::string participant;
  std::string out;
  bool force = false;
  bool now = false;
  std::string sensor, rig, recording;
  double from_s = 0, to_s = 0;
  std::vector<std::string> group;
};

Result<void> Check(const RangesOptions& options) {
  const std::string& interface = options.played.interface;
  if (interface.empty()) {
    return UsageError("name the interface: --interface wrist, arm, leg, joystick or boards");
  }
  if (stream::UserInterfaceNamed(interface) == stream::UserInterface::kUnspecified) {
    return UsageError("ranges are measured of wrist, arm, leg, joystick and boards, not of \"" +
                      interface + "\"");
  }
  const std::string& turn_by = options.played.turn_by;
  if (stream::LegTurnSourceNamed(turn_by) == stream::TurnSource::kUnspecified) {
    return UsageError("unknown --turn-by " + turn_by + "; there are: head, trunk, feet");
  }
  if (options.participant.empty()) {
    return UsageError("--participant CODE is missing: a code, never a name");
  }
  if (!plan::IsCode(options.participant)) {
    return UsageError("--participant \"" + options.participant + "\": " + plan::kCodeRule);
  }
  if (options.to_s != 0 && options.to_s <= options.from_s) {
    return UsageError("--to must be later than --from");
  }
  return {};
}

Result<RecordedRanges> MeasureLive(const RangesOptions& options) {
  // Before a person moves for 20 s.
  const auto creatable = recording::CheckCreatable(options.out, options.force);
  if (!creatable) return creatable.error();
  const auto sensor = transport::AddressOrDefault(options.sensor, "sensor");
  if (!sensor) return sensor.error();
  Console console;
  if (!options.now) {
    const auto ready = console.Ask("Read each motion aloud; they take " +
                                   text::Fixed(ranges::DurationOf(options.played), 0) +
                                   " s. Press Enter to begin:");
    if (!ready) return ready.error();
  }
  return MeasureRanges(console, *sensor, options.rig, options.played);
}

/// Of one person, live or from a recording.
Result<ranges::Measured> MeasureOne(const RangesOptions& options) {
  if (const auto checked = Check(options); !checked) return checked.error();
  const bool live = options.recording.empty();
  auto measured = live ? MeasureLive(options)
                       : RangesInRecording(options.recording, options.played, options.rig,
                                           options.from_s, options.to_s);
  if (!measured) return measured.error();
  ranges::Measured one{options.played, std::move(measured->ranges), {}};
  one.provenance.participants = {options.participant};
  one.provenance.how = live ? "live" : "recording " + options.recording;
  one.provenance.simulated = measured->simulated;
  return one;
}

Result<ranges::Measured> MergeGroup(const RangesOptions& options) {
  std::vector<ranges::Measured> people;
  for (const std::string& path : options.group) {
    const auto text = config::ReadTextFile(path);
    if (!text) return text.error();
    auto one = ranges::MeasuredOf(*text, path);
    if (!one) return one.error();
    people.push_back(std::move(*one));
  }
  auto group = ranges::Merge(people);
  if (group) group->provenance.how = "median over the group";
  return group;
}

Result<Answer> MakeTable(const RangesOptions& options) {
  auto measured = options.group.empty() ? MeasureOne(options) : MergeGroup(options);
  if (!measured) return measured.error();
  measured->provenance.when = text::Utc(clock::WallNs());
  measured->provenance.by = std::string("footing-study ") + cli::Version();
  const auto built_in = config::ReadDataFile(measured->played.interface + "_mapping.json");
  if (!built_in) return built_in.error();
  const auto table =
      ranges::TableOf(measured->played, measured->ranges, measured->provenance, *built_in);
  if (!table) return table.error();
  auto file = recording::OutputFile::Create(options.out, options.force);
  if (!file) return file.error();
  if (const auto done = file->Write(table->dump(2) + "\n"); !done) return done.error();
  if (const auto done = file->Sync(); !done) return done.error();
  std::string text = "wrote " + options.out + ", ranges of " + measured->played.interface + ":";
  for (const auto& [name, range] : (*table)["measured"]["ranges"].items()) {
    text += "\n  " + name + ": " + range["low"].dump() + " to " + range["high"].dump();
  }
  return Answer{{{"file", options.out}, {"measured", (*table)["measured"]}, {"table", *table}},
                text};
}

}  // namespace

void AddRangesCommand(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<RangesOptions>();
  CLI::App* command = app.add_subcommand(
      "ranges", "Measure a person's comfortable range for an interface, or merge a group's");
  command->add_option("--interface", options->played.interface,
                      "Interface: wrist, arm, leg, joystick or boards");
  command->add_option(
      "--turn-by", options->played.turn_by,
      "Body part that steers with the interface leg: head, trunk or feet (default: head)");
  command->add_option("--participant", options->participant, "Code of the person");
  command->add_option("--out", options->out, "Mapping table to write, JSON")->required();
  command->add_flag("--force", options->force, "Overwrite an existing file");
  command->add_option("--sensor", options->sensor, "Address of footingd");
  command->add_option("--rig", options->rig, "Rig (default: the first with the devices)");
  command->add_flag("--now", options->now, "Begin immediately, without a key press");
  CLI::Option* recording =
      command->add_option("--recording", options->recording,
                          "Recording to measure instead of a live person, MCAP file");
  command->add_option("--from", options->from_s, "Start in the recording, s")->needs(recording);
  command->add_option("--to", options->to_s, "End in the recording, s (default: its end)")
      ->needs(recording);
  command
      ->add_option("--group", options->group,
                   "Merge the tables of several persons: the median of each end")
      ->excludes(recording);
  command->footer(
      "Examples:\n"
      "  footing-study ranges --interface wrist --participant P01 --out P01_wrist.json\n"
      "  footing-study ranges --interface leg --participant P01 --recording practice.mcap --out "
      "P01_leg.json\n"
      "  footing-study ranges --group P01_wrist.json P02_wrist.json --out group_wrist.json\n"
      "  footing-ctl interface wrist --table P01_wrist.json");
  command->callback([options, &shared] { Finish(MakeTable(*options), shared); });
}

}  // namespace footing::study
