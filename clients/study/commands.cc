#include "clients/study/commands.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <set>
#include <utility>

#include "clients/study/session/journal.h"
#include "clients/study/session/study_folder.h"
#include "clients/study/plan/ranges.h"
#include "common/cli/cli.h"
#include "common/runtime/data_file.h"
#include "common/base/json_text.h"

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

}  // namespace footing::study
