#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>

#include "clients/study/commands.h"
#include "clients/study/plan/phases.h"
#include "clients/study/report/latency.h"
#include "clients/study/simulate_study.h"
#include "common/runtime/clock.h"
#include "common/base/number.h"
#include "common/base/units.h"

namespace footing::study {
namespace {

struct SimulateOptions {
  std::string protocol;
  std::string folder;
  std::vector<std::string> participants;
  std::uint64_t seed = 1;
  int jobs = 0;
  bool real_time = false;
};

/// Those that are asked for; all where none is named.
Result<std::vector<plan::Session>> Chosen(const SimulateOptions& given,
                                          const plan::Protocol& protocol) {
  std::vector<plan::Session> sessions = plan::MakeSessions(protocol);
  if (given.participants.empty()) return sessions;
  for (const std::string& code : given.participants) {
    const auto& known = protocol.participants;
    if (std::find(known.begin(), known.end(), code) == known.end()) {
      return UsageError("participant " + code + " is not in the protocol");
    }
  }
  std::erase_if(sessions, [&](const plan::Session& session) {
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
                               given.real_time, loaded->protocol.settings.turn_by});
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
  command->callback([given, &shared] { Finish(Simulate(*given), shared); });
}

}  // namespace footing::study
