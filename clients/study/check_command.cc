#include <memory>
#include <utility>

#include "clients/study/commands.h"
#include "clients/study/plan/phases.h"
#include "common/runtime/data_file.h"
#include "common/base/number.h"

namespace footing::study {
namespace {

using nlohmann::ordered_json;

constexpr const char* kSchemaFile = "study_protocol.schema.json";

struct CheckOptions {
  ProtocolOptions protocol;
  bool schema = false;
};

double PlannedS(const plan::Session& session) {
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
std::string Line(const plan::Session& session) {
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
  for (const plan::Session& session : sessions) {
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

}  // namespace footing::study
