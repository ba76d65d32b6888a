#include "clients/study/commands.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "clients/study/plan/phases.h"
#include "clients/study/plan/ranges.h"
#include "clients/study/plan/screen_message.h"
#include "clients/study/report/analysis.h"
#include "clients/study/report/page.h"
#include "clients/study/session/console.h"
#include "clients/study/session/journal.h"
#include "clients/study/session/range_run.h"
#include "clients/study/session/run_session.h"
#include "clients/study/simulate_study.h"
#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/cli/statistics_options.h"
#include "common/net/address.h"
#include "common/net/framing.h"
#include "common/recording/recording_writer.h"
#include "common/runtime/clock.h"
#include "common/runtime/files.h"
#include "common/runtime/timer.h"
#include "common/stream/leg_turn.h"
#include "common/stream/user_interface.h"

namespace footing::study {
namespace {

/// The text of a built-in track.
Result<std::string> ReadTrack(const std::string& key, const std::string& track,
                              const std::string& file) {
  if (track.find('/') != std::string::npos || track.find('.') != std::string::npos) {
    return InvalidData(file + ": " + key + " has \"" + track +
                       "\"; a study uses built-in tracks, by their names");
  }
  auto found = config::ReadNamed(track, "tracks");
  if (found) return found;
  return InvalidData(file + ": " + key + " has unknown track \"" + track +
                     "\": " + found.error().message);
}

/// A track that may be left, or that grows, has none unless it names one (docs/tracks.md).
bool HasFinishLine(const std::string& track_text) {
  using nlohmann::json;
  const json track = json::parse(track_text, nullptr, /*allow_exceptions=*/false);
  if (!track.is_object()) return true;
  if (track.contains("finish_m")) return track.value("finish_m", 0.0) > 0;
  for (const char* key : {"open", "extendable", "endless"}) {
    if (track.value(key, false)) return false;
  }
  return true;
}

/// Each task must be one of the straight track's.
Result<void> CheckTasks(const plan::Protocol& protocol, const std::string& track_text,
                        const std::string& file) {
  using nlohmann::json;
  const json track = json::parse(track_text, nullptr, /*allow_exceptions=*/false);
  const json none = json::object();
  const json& mark = track.is_object() && track.contains("mark") ? track["mark"] : none;
  std::string names;
  std::set<std::string> known;
  for (const json& task : mark.value("tasks", json::array())) {
    known.insert(task.value("name", ""));
    names += (names.empty() ? "" : ", ") + task.value("name", "");
  }
  for (const std::string& task : protocol.straight_tasks) {
    if (known.count(task) != 0) continue;
    return InvalidData(file + ": straight_tasks has \"" + task + "\", which track " +
                       protocol.straight_track +
                       " does not have; there are: " + (names.empty() ? "none" : names));
  }
  return {};
}

/// The tables that the protocol names, beside it.
Result<std::map<std::string, std::string>> ReadTables(const plan::Protocol& protocol,
                                                      const std::string& file) {
  std::map<std::string, std::string> tables;
  for (const auto& [interface, name] : protocol.settings.tables) {
    const std::filesystem::path path = std::filesystem::path(file).parent_path() / name;
    auto text = config::ReadTextFile(path.string());
    if (!text) return Error{text.error().kind, file + ": tables: " + text.error().message};
    const auto measured = ranges::MeasuredOf(*text, path.string());
    if (!measured)
      return Error{measured.error().kind, file + ": tables: " + measured.error().message};
    const ranges::Played& played = measured->played;
    const bool turns = interface != "leg" || played.turn_by == protocol.settings.turn_by;
    if (played.interface != interface || !turns) {
      return InvalidData(file + ": tables has " + name + " for " + interface +
                         ", which was measured of " + played.interface +
                         (played.interface == "leg" ? " turned by " + played.turn_by : ""));
    }
    tables[interface] = std::move(*text);
  }
  return tables;
}

}  // namespace

Result<LoadedProtocol> Load(const std::string& path, const std::string& folder) {
  auto text = config::ReadTextFile(path);
  if (!text) return text.error();
  auto protocol = plan::ParseProtocol(*text, path);
  if (!protocol) return protocol.error();
  const auto practice = ReadTrack("practice_track", protocol->practice_track, path);
  if (!practice) return practice.error();
  const auto straight = ReadTrack("straight_track", protocol->straight_track, path);
  if (!straight) return straight.error();
  if (const auto done = CheckTasks(*protocol, *straight, path); !done) return done.error();
  std::vector<std::string> remarks;
  for (const std::string& track : protocol->test_tracks) {
    const auto found = ReadTrack("test_tracks", track, path);
    if (!found) return found.error();
    if (HasFinishLine(*found)) continue;
    remarks.push_back("test track " + track +
                      " has no finish line: a trial on it ends when trial_limit_s is over, or by "
                      "the experimenter");
  }
  auto tables = ReadTables(*protocol, path);
  if (!tables) return tables.error();
  return LoadedProtocol{path,
                        std::move(*text),
                        std::move(*protocol),
                        folder.empty() ? journal::FolderOf(path) : folder,
                        std::move(*tables),
                        std::move(remarks)};
}

namespace {

Error JournalLost(const std::string& path) {
  return InvalidData(path +
                     " has no event, but there are recordings beside it; restore it, or move "
                     "the folder away");
}

Result<void> CheckRatings(const records::Records& records, const std::string& path) {
  for (const records::Rating& one : records.ratings) {
    const bool exertion = one.item == plan::kExertionItem;
    const int least = exertion ? 0 : plan::kLeastRating;
    const int most = exertion ? plan::kMostExertion : plan::kMostRating;
    if (one.value >= least && one.value <= most) continue;
    return InvalidData(path + ": " + one.item + " of " + one.interface + " is rated " +
                       nlohmann::json(one.value).dump() + ", must be from " +
                       std::to_string(least) + " to " + std::to_string(most));
  }
  return {};
}

}  // namespace

Result<std::vector<records::Records>> ReadPeople(const LoadedProtocol& loaded) {
  if (const auto done = journal::CheckProtocol(loaded.folder, loaded.text); !done) {
    return done.error();
  }
  for (const std::string& code : journal::Participants(loaded.folder)) {
    const auto& codes = loaded.protocol.participants;
    if (std::find(codes.begin(), codes.end(), code) != codes.end()) continue;
    return InvalidData(journal::ParticipantFolder(loaded.folder, code) +
                       " has a journal, and participants of " + loaded.path + " does not have " +
                       code + "; add the code, or move the folder away");
  }
  std::vector<records::Records> people;
  for (const std::string& participant : loaded.protocol.participants) {
    const std::string path = journal::JournalPath(loaded.folder, participant);
    if (!journal::Exists(path)) {
      if (journal::HasRecordings(loaded.folder, participant)) return JournalLost(path);
      continue;
    }
    const auto text = journal::ReadJournal(path);
    if (!text) return text.error();
    const auto own = journal::RequireParticipant(text->events, participant, path);
    if (text->events.empty()) {
      if (journal::HasRecordings(loaded.folder, participant)) return JournalLost(path);
      continue;  // It ended before its session began.
    }
    if (!own) return own.error();
    records::Records records = records::Collect(text->events);
    if (const auto done = CheckRatings(records, path); !done) return done.error();
    people.push_back(std::move(records));
  }
  if (!people.empty()) return people;
  return Failure(
      loaded.folder +
      " has no journal yet; run a session first (footing-study run), or name the folder of "
      "the sessions with --folder");
}

void Finish(const Result<Answer>& result, Shared& shared) {
  if (!result) {
    shared.exit_code = cli::Report(result.error());
    return;
  }
  using nlohmann::ordered_json;
  std::cout << (shared.json ? text::ToText(result->json) : result->text) << std::endl;
}

void AddProtocolOptions(CLI::App& command, ProtocolOptions& options) {
  command.add_option("PROTOCOL", options.path, "Protocol file, JSON (docs/studies.md)")->required();
  command.add_option("--folder", options.folder,
                     "Folder of the study's files (default: the protocol's path with .study in "
                     "place of .json)");
}

namespace {

using nlohmann::ordered_json;

constexpr const char* kSchemaFile = "study_protocol.schema.json";

struct CheckOptions {
  ProtocolOptions protocol;
  bool schema = false;
};

double PlannedS(const plan::SessionPlan& session) {
  double planned_s = 0;
  for (const plan::Phase& phase : session.phases) planned_s += phase.duration_s;
  return planned_s;
}

ordered_json ToJson(const plan::Phase& phase) {
  ordered_json json = {{"phase", phase.id}, {"kind", Name(phase.kind)}};
  if (!phase.interface.empty()) json["interface"] = phase.interface;
  if (!phase.track.empty()) json["track"] = phase.track;
  if (!phase.task.empty()) json["task"] = phase.task;
  if (phase.duration_s > 0) json["duration_s"] = phase.duration_s;
  if (phase.is_trial()) json["seed"] = phase.seed;
  return json;
}

/// One line for each participant: the interfaces in their order, each with its tasks and track.
std::string Line(const plan::SessionPlan& session) {
  std::string line = "  " + session.participant + ": ";
  for (const std::string& interface : session.interfaces) {
    if (interface != session.interfaces.front()) line += "; ";
    line += interface;
    std::string separator = " (";
    for (const plan::Phase& phase : session.phases) {
      if (!phase.is_trial() || phase.interface != interface) continue;
      line += separator + (phase.task.empty() ? "track " + phase.track : phase.task);
      separator = ", ";
    }
    if (separator == ", ") line += ")";
  }
  return line;
}

Result<Answer> PrintSchema() {
  auto text = config::ReadDataFile(kSchemaFile);
  if (!text) return text.error();
  ordered_json schema = ordered_json::parse(*text, nullptr, /*allow_exceptions=*/false);
  if (schema.is_discarded()) return InvalidData(std::string(kSchemaFile) + ": not JSON");
  while (text->ends_with('\n')) text->pop_back();
  return Answer{std::move(schema), std::move(*text)};
}

Result<Answer> Check(const CheckOptions& options) {
  if (options.schema) return PrintSchema();
  if (options.protocol.path.empty()) {
    return UsageError("PROTOCOL is missing: name a protocol file, or --schema");
  }
  const auto loaded = Load(options.protocol.path, options.protocol.folder);
  if (!loaded) return loaded.error();
  const plan::Protocol& protocol = loaded->protocol;
  const auto sessions = plan::MakeSessions(protocol);
  std::vector<std::string> remarks = plan::Remarks(protocol);
  remarks.insert(remarks.end(), loaded->remarks.begin(), loaded->remarks.end());
  Answer answer;
  answer.json = {{"name", protocol.name},
                 {"seed", protocol.seed},
                 {"order", Name(protocol.order)},
                 {"control", protocol.control},
                 {"folder", loaded->folder},
                 {"remarks", remarks},
                 {"sessions", ordered_json::array()}};
  answer.text = protocol.name + ": " + std::to_string(sessions.size()) +
                (sessions.size() == 1 ? " participant" : " participants") + ", order " +
                Name(protocol.order) + ", seed " + std::to_string(protocol.seed) + ", control " +
                protocol.control + "; data in " + loaded->folder + "\n";
  for (const plan::SessionPlan& session : sessions) {
    ordered_json phases = ordered_json::array();
    for (const plan::Phase& phase : session.phases) phases.push_back(ToJson(phase));
    answer.json["sessions"].push_back({{"participant", session.participant},
                                       {"interfaces", session.interfaces},
                                       {"phases", std::move(phases)}});
    answer.text += Line(session) + "\n";
  }
  answer.text +=
      "Practice and rests of a session: " + text::Fixed(PlannedS(sessions.front()) / 60, 1) +
      " min.";
  for (const std::string& remark : remarks) answer.text += "\nNote: " + remark;
  return answer;
}

}  // namespace

void AddCheckCommand(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand("check", "Check a protocol and print its plan");
  AddProtocolOptions(*command, options->protocol);
  command->get_option("PROTOCOL")->required(false);
  command->add_flag("--schema", options->schema,
                    "Print the JSON Schema of protocol files, for editors and other programs");
  command->callback([options, &shared] { Finish(Check(*options), shared); });
}

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

/// Measures the ranges of one person, live or from a recording.
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

namespace {

struct ReportOptions {
  ProtocolOptions protocol;
  statistics_options::Options tests{"two.sided", "pairwise", ""};
  std::optional<std::uint64_t> seed;
  std::string out;
  bool force = false;
};

Result<void> Write(const std::string& path, const std::string& text, bool force) {
  auto file = recording::OutputFile::Create(path, force);
  if (!file) return file.error();
  if (const auto done = file->Write(text); !done) return done;
  return file->Sync();
}

/// The study's records with the analysis of them.
struct Analysed {
  LoadedProtocol loaded;
  std::vector<records::Records> people;
  report::Analysis analysis;
};

Result<Analysed> ReadAndAnalyze(const ReportOptions& options) {
  auto loaded = Load(options.protocol.path, options.protocol.folder);
  if (!loaded) return loaded.error();
  auto people = ReadPeople(*loaded);
  if (!people) return people.error();
  const auto chosen = statistics_options::ChosenIn(options.tests);
  const report::TestOptions tests{chosen.alternative, chosen.ties, chosen.method, options.seed};
  report::Analysis analysis = report::Analyze(loaded->protocol, *people, tests);
  return Analysed{std::move(*loaded), std::move(*people), std::move(analysis)};
}

Result<Answer> Analyze(const ReportOptions& options) {
  const auto analysed = ReadAndAnalyze(options);
  if (!analysed) return analysed.error();
  return Answer{analysed->analysis.json, report::Summary(analysed->analysis)};
}

Result<Answer> Report(const ReportOptions& options) {
  const auto analysed = ReadAndAnalyze(options);
  if (!analysed) return analysed.error();
  const auto& [loaded, people, analysis] = *analysed;
  const std::string page = options.out.empty() ? loaded.folder + "/report.html" : options.out;
  const std::string csv =
      (page.ends_with(".html") ? page.substr(0, page.size() - 5) : page) + ".csv";
  const std::string html = report::Page(analysis, loaded.protocol, people);
  if (const auto done = Write(page, html, options.force); !done) return done.error();
  if (const auto done = Write(csv, report::ValuesCsv(analysis), options.force); !done) {
    return done.error();
  }
  return Answer{{{"page", page}, {"csv", csv}, {"synthetic", analysis.synthetic}},
                "wrote " + page + " and " + csv};
}

void AddTestOptions(CLI::App& command, ReportOptions& options) {
  statistics_options::Add(command, options.tests,
                          "Source of Steel's p (default: exact where feasible, otherwise "
                          "permutation)");
  command.add_option("--seed", options.seed,
                     "Seed of the random permutations (default: the protocol's)");
}

}  // namespace

void AddReportCommands(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* analyze = app.add_subcommand("analyze", "Compare the interfaces with the control");
  AddProtocolOptions(*analyze, options->protocol);
  AddTestOptions(*analyze, *options);
  analyze->callback([options, &shared] { Finish(Analyze(*options), shared); });
  CLI::App* report = app.add_subcommand("report", "Write the analysis as an HTML page and a CSV");
  AddProtocolOptions(*report, options->protocol);
  AddTestOptions(*report, *options);
  report->add_option("--out", options->out,
                     "HTML file; the CSV is beside it (default: report.html in the folder)");
  report->add_flag("--force", options->force, "Overwrite existing files");
  report->callback([options, &shared] { Finish(Report(*options), shared); });
}

namespace {

struct RunOptions {
  ProtocolOptions protocol;
  std::string participant;
  bool unattended = false;
  std::uint64_t seed = 1;
  std::string sensor;
  std::string simulation;
  std::string survey;
  bool asks_on_screen = false;
  bool withdraw = false;
  std::optional<std::uint64_t> undo, restore;
  std::string reason;
};

Result<SessionOptions> ToSession(const RunOptions& given, const LoadedProtocol& loaded) {
  SessionOptions options;
  options.participant = given.participant;
  options.study_folder = loaded.folder;
  options.protocol_text = loaded.text;
  options.unattended = given.unattended;
  options.answer_seed = given.seed;
  options.version = cli::Version();
  options.tables = loaded.tables;
  const auto sensor = transport::AddressOrDefault(given.sensor, "sensor");
  if (!sensor) return sensor.error();
  options.sensor = *sensor;
  const auto simulation = transport::AddressOrDefault(given.simulation, "simulation");
  if (!simulation) return simulation.error();
  options.simulation = *simulation;
  if (given.asks_on_screen && given.survey.empty()) {
    options.survey = transport::DefaultAddress("survey", true);
  } else if (given.asks_on_screen) {
    const auto parsed = transport::ParseAddress(given.survey);
    if (!parsed) return parsed.error();
    options.survey = *parsed;
  }
  return options;
}

Result<Answer> Run(const RunOptions& given) {
  const auto loaded = Load(given.protocol.path, given.protocol.folder);
  if (!loaded) return loaded.error();
  const auto options = ToSession(given, *loaded);
  if (!options) return options.error();
  std::string did = "finished";
  Result<void> done;
  if (given.withdraw) {
    did = "withdrawn";
    done = AppendToSession(*options, loaded->protocol, records::EventKind::kWithdrawn,
                           {{"reason", given.reason}});
  } else if (given.undo || given.restore) {
    did = given.undo ? "failure undone" : "failure restored";
    done = AppendToSession(
        *options, loaded->protocol,
        given.undo ? records::EventKind::kFailureUndone : records::EventKind::kFailureRestored,
        {{"failure", given.undo ? *given.undo : *given.restore}, {"reason", given.reason}});
  } else {
    done = clock::FollowTimekeeper();
    if (done) done = RunSession(*options, loaded->protocol);
  }
  if (!done) return done.error();
  return Answer{{{"participant", given.participant}, {"result", did}, {"folder", loaded->folder}},
                given.participant + ": " + did};
}

}  // namespace

void AddRunCommand(CLI::App& app, Shared& shared) {
  const auto given = std::make_shared<RunOptions>();
  CLI::App* command =
      app.add_subcommand("run", "Run or resume the session of a participant, or correct it");
  AddProtocolOptions(*command, given->protocol);
  command->add_option("--participant", given->participant, "Code of the participant")->required();
  command->add_option("--sensor", given->sensor, "Address of footingd");
  command->add_option("--simulation", given->simulation, "Address of footing-sim");
  const CLI::Option* const survey =
      command
          ->add_option("--survey", given->survey,
                       "Ask on the participant's screen, that of footing-web or footing-study "
                       "survey, which connects to this address (default: one of this user; without "
                       "--survey: ask in this terminal)")
          ->expected(0, 1);
  command->add_flag("--unattended", given->unattended,
                    "Without a person: no prompts and no waiting; surveys are answered at random, "
                    "marked synthetic");
  command->add_option("--seed", given->seed, "Seed of unattended answers");
  CLI::Option* withdraw =
      command->add_flag("--withdraw", given->withdraw,
                        "Record that the participant withdraws: no analysis uses the data");
  CLI::Option* undo =
      command->add_option("--undo-failure", given->undo, "Do not count the failure of this number");
  CLI::Option* restore = command->add_option("--restore-failure", given->restore,
                                             "Count the failure of this number again");
  withdraw->excludes(undo)->excludes(restore);
  undo->excludes(restore);
  command->add_option("--reason", given->reason, "Reason of a withdrawal or correction");
  command->callback([given, survey, &shared] {
    given->asks_on_screen = survey->count() > 0;
    Finish(Run(*given), shared);
  });
}

namespace {

struct SimulateOptions {
  std::string protocol;
  std::string folder;
  std::vector<std::string> participants;
  std::uint64_t seed = 1;
  int jobs = 0;
  bool real_time = false;
  std::string devices = "wiimote";
};

/// Those that are asked for; all where none is named.
Result<std::vector<plan::SessionPlan>> Chosen(const SimulateOptions& given,
                                              const plan::Protocol& protocol) {
  std::vector<plan::SessionPlan> sessions = plan::MakeSessions(protocol);
  if (given.participants.empty()) return sessions;
  for (const std::string& code : given.participants) {
    const auto& known = protocol.participants;
    if (std::find(known.begin(), known.end(), code) == known.end()) {
      return UsageError("participant " + code + " is not in the protocol");
    }
  }
  std::erase_if(sessions, [&](const plan::SessionPlan& session) {
    const auto& wanted = given.participants;
    return std::find(wanted.begin(), wanted.end(), session.participant) == wanted.end();
  });
  return sessions;
}

/// Appends the latency of each interface without the wait for contact, and without the rest of the
/// features' window: they are what depends on the machine.
Result<void> AddLatency(const LoadedProtocol& loaded, Answer& answer) {
  const auto people = ReadPeople(loaded);
  if (!people) return people.error();
  answer.json["latency"] = nlohmann::ordered_json::array();
  for (const auto& one : report::LatencyByStage(loaded.protocol.interfaces, *people)) {
    answer.json["latency"].push_back({{"interface", one.interface},
                                      {"stage", one.stage},
                                      {"responses", one.responses},
                                      {"p50_ms", one.p50_ms},
                                      {"p95_ms", one.p95_ms}});
    if (one.stage != report::kWithoutContact && one.stage != report::kWithoutWindow) continue;
    answer.text += "\n" + one.interface + ": latency " + one.stage + " " +
                   text::Fixed(one.p50_ms, 1) + " ms, 95 % within " + text::Fixed(one.p95_ms, 1) +
                   " ms, " + std::to_string(one.responses) + " responses";
  }
  return {};
}

Result<Answer> Simulate(const SimulateOptions& given) {
  const auto loaded = Load(given.protocol, given.folder);
  if (!loaded) return loaded.error();
  auto sessions = Chosen(given, loaded->protocol);
  if (!sessions) return sessions.error();
  const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const std::int64_t begin_ns = clock::MonotonicNs();
  const auto times =
      simulate::SimulateStudy({loaded->path, loaded->text, loaded->folder, std::move(*sessions),
                               given.seed, given.jobs > 0 ? given.jobs : processors,
                               given.real_time, loaded->protocol.settings.turn_by, given.devices});
  if (!times) return times.error();
  const double took_s = NanosecondsToSeconds(clock::MonotonicNs() - begin_ns);
  Answer answer{{{"folder", loaded->folder},
                 {"took_s", took_s},
                 {"sessions", nlohmann::ordered_json::array()}},
                ""};
  double simulated_s = 0;
  for (const simulate::SessionTime& one : *times) {
    answer.json["sessions"].push_back({{"participant", one.participant},
                                       {"simulated_s", one.simulated_s},
                                       {"before", one.before}});
    if (!one.before) simulated_s += one.simulated_s;
  }
  answer.json["simulated_s"] = simulated_s;
  answer.text = loaded->folder + ": " + std::to_string(times->size()) +
                (times->size() == 1 ? " session" : " sessions") + "; simulated " +
                text::Fixed(simulated_s, 0) + " s in " + text::Fixed(took_s, 0) + " s";
  if (const auto done = AddLatency(*loaded, answer); !done) return done.error();
  return answer;
}

}  // namespace

void AddSimulateCommand(CLI::App& app, Shared& shared) {
  const auto given = std::make_shared<SimulateOptions>();
  CLI::App* command = app.add_subcommand(
      "simulate",
      "Run the sessions of synthetic participants on simulated time: no person, device or waiting");
  command->add_option("PROTOCOL", given->protocol, "Protocol file, JSON (docs/studies.md)")
      ->required();
  command->add_option("--folder", given->folder, "Folder of the simulated study's files")
      ->required();
  command->add_option("--participant", given->participants,
                      "Code of a participant; may be repeated (default: all)");
  command->add_option("--seed", given->seed, "Seed of the participants' styles and answers");
  command
      ->add_option("--jobs", given->jobs,
                   "Number of sessions at once (default 0: one per processor)")
      ->check(CLI::Range(0, 256));
  command->add_flag(
      "--real-time", given->real_time,
      "On the host's time, as a live study, to measure latencies; best with --jobs 1");
  command
      ->add_option("--devices", given->devices,
                   "Devices that participants hold or wear: wiimote or joycon (default wiimote)")
      ->check(CLI::IsMember({"wiimote", "joycon"}));
  command->callback([given, &shared] { Finish(Simulate(*given), shared); });
}

namespace {

constexpr auto kDialEvery = std::chrono::milliseconds(500);
constexpr double kForeverS = 365 * 24 * 3600;
constexpr const char* kHomeAndClear = "\x1b[H\x1b[J";

/// The survey as the participant sees it: one question at a time, answered with the keyboard.
class ScreenClient {
 public:
  ScreenClient(Console& console, transport::Address address)
      : console_(console), address_(std::move(address)), timer_(console.io()) {}

  /// Until the program is interrupted.
  void Run() {
    console_.ReadKeys(false);
    shown_.item = "Waiting for the experimenter.";
    Draw("");
    Dial();
    console_.RunUntil([this] { return TakeLine(), false; }, kForeverS);
  }

 private:
  void Dial() {
    transport::Dial(console_.io(), address_, [this](Result<transport::Socket> socket) {
      if (!socket) return DialLater();
      connection_ = std::make_unique<transport::FramedConnection>(
          std::move(*socket), transport::FramedLimits{.max_in_bytes = screen::kMostFrameBytes},
          transport::FramedHandlers{
              .on_frame = [this](std::string_view payload) { OnFrame(payload); },
              .on_close =
                  [this](const std::string&) {
                    shown_ = {.item = "Waiting for the experimenter."};
                    Draw("");
                    DialLater();
                  },
              .on_writable = {},
              .on_bytes = {},
              .on_bad_input = {}});
      connection_->Start();
    });
  }

  void DialLater() {
    timer_.After(kDialEvery, [this] { Dial(); });
  }

  void OnFrame(std::string_view payload) {
    auto shown = screen::ParseShown(payload);
    if (!shown) return;
    shown_ = std::move(*shown);
    console_.DropTypedAhead();
    Draw("");
  }

  void TakeLine() {
    const auto line = console_.TakeLine();
    if (!line || shown_.number == 0 || !connection_ || !connection_->open()) return;
    if (!screen::Answers(shown_, *line)) {
      return Draw(shown_.is_rating() ? "Type a number from " + std::to_string(shown_.least) +
                                           " to " + std::to_string(shown_.greatest) + "."
                                     : "Type one of them: the number or the name.");
    }
    connection_->Send(
        screen::ToText(screen::Reply{shown_.number, line->substr(0, screen::kMostAnswerBytes)}));
  }

  void Draw(const std::string& hint) {
    std::string text = kHomeAndClear;
    if (shown_.number == 0) return console_.Print(text + "\n\n  " + shown_.item + "\n");
    text += "\n  " + shown_.title + "   " + std::to_string(shown_.position) + " of " +
            std::to_string(shown_.count) + "\n\n  " + shown_.item + "\n\n";
    if (shown_.is_rating()) {
      for (int value = shown_.least; value <= shown_.greatest; ++value) {
        text += "    " + std::to_string(value);
      }
      text += "\n\n  " + shown_.scale + "\n\n";
    }
    for (std::size_t i = 0; i < shown_.choices.size(); ++i) {
      text += "    " + std::to_string(i + 1) + "  " + shown_.choices[i] + "\n";
    }
    if (!shown_.choices.empty()) text += "\n";
    text += hint.empty() ? "" : "  " + hint + "\n\n";
    const bool number = shown_.is_rating() || !shown_.choices.empty();
    console_.Print(
        text + (number ? "  Type a number and press Enter:" : "  Type one line and press Enter:"));
  }

  Console& console_;
  const transport::Address address_;
  timer::Timer timer_;
  std::unique_ptr<transport::FramedConnection> connection_;
  screen::Shown shown_;
};

Result<void> ShowSurveys(const std::string& address) {
  const auto parsed = transport::AddressOrDefault(address, "survey");
  if (!parsed) return parsed.error();
  Console console;
  ScreenClient(console, *parsed).Run();
  return {};
}

}  // namespace

void AddSurveyCommand(CLI::App& app, Shared& shared) {
  const auto address = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "survey", "The participant's survey screen: a terminal that shows and answers the questions");
  command->add_option("--connect", *address,
                      "Address of footing-study run --survey (default: that of this user)");
  command->footer(
      "Examples:\n"
      "  footing-study run study.json --participant P01 --survey\n"
      "  footing-study survey\n"
      "  footing-study survey --connect unix:/tmp/survey.sock");
  command->callback([address, &shared] {
    if (const auto done = ShowSurveys(*address); !done)
      shared.exit_code = cli::Report(done.error());
  });
}

}  // namespace footing::study
