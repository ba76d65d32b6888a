#include <utility>

#include "clients/study/session/measure_ranges.h"
#include "clients/study/session/run_session.h"
#include "common/runtime/clock.h"
#include "common/runtime/data_file.h"
#include "common/base/lines.h"
#include "common/base/number.h"
#include "common/base/utc.h"

namespace footing::study {
namespace {

using nlohmann::ordered_json;
using records::EventKind;

constexpr const char* kByMeasurement = "measured";
constexpr const char* kByProtocol = "protocol";
constexpr const char* kByBuiltIn = "built-in";

}  // namespace

Result<std::string> SessionRun::TableOf(const std::string& interface) {
  const std::vector<records::Event>& events = context_.journal.events();
  for (auto event = events.rbegin(); event != events.rend(); ++event) {
    if (event->kind != EventKind::kRanges || event->Text("interface") != interface) continue;
    const auto table = event->fields.find("table");
    return table == event->fields.end() || table->is_null() ? std::string() : table->dump();
  }
  const auto given = context_.options.tables.find(interface);
  if (given == context_.options.tables.end()) return std::string();
  const auto noted = NoteTable(interface, kByProtocol, given->second, "");
  if (!noted) return noted.error();
  return TableOf(interface);  // As the journal has it.
}

Result<std::string> SessionRun::TableToSend(const std::string& interface) {
  auto table = TableOf(interface);
  if (!table || interface != "leg" || !context_.protocol.settings.camera_roll) return table;
  if (table->empty()) table = config::ReadDataFile(interface + "_mapping.json");
  if (!table) return table;
  ordered_json values = ordered_json::parse(*table, nullptr, false, true);
  if (!values.is_object()) return InvalidData("the table of " + interface + " is not JSON");
  values["camera_roll"] = true;
  return values.dump();
}

Result<void> SessionRun::NoteTable(const std::string& interface, const std::string& by,
                                   const std::string& table, const std::string& reason) {
  ordered_json fields = {
      {"interface", interface}, {"by", by}, {"synthetic", context_.options.unattended}};
  if (!reason.empty()) fields["reason"] = reason;
  fields["table"] =
      table.empty() ? ordered_json() : ordered_json::parse(table, nullptr, false, true);
  return context_.journal.Append(EventKind::kRanges, std::move(fields));
}

Result<void> SessionRun::MeasureRanges(const plan::Phase& phase) {
  const std::string& interface = phase.interface;
  if (context_.options.unattended) {
    const auto before = TableOf(interface);
    if (!before) return before.error();
    return NoteTable(interface, before->empty() ? kByBuiltIn : kByProtocol, *before,
                     "no person takes part");
  }
  const auto servers = UseInterface(interface);
  if (!servers) return servers.error();
  const auto built_in = config::ReadDataFile(interface + "_mapping.json");
  if (!built_in) return built_in.error();
  const ranges::Played played{interface, context_.protocol.settings.turn_by};
  for (;;) {
    Show(stream::StudyActivity::kRanges,
         "Measure the participant's own ranges: read each motion aloud.", "Enter begins");
    const auto ready = context_.console.Ask("Next: the participant's own ranges, " +
                                            text::Fixed(ranges::DurationOf(played), 0) +
                                            " s. Read each motion aloud. Press Enter to begin:");
    if (!ready) return ready.error();
    const auto measured =
        study::MeasureRanges(context_.console, context_.options.sensor, "", played);
    if (context_.console.interrupted()) return Interrupted();
    auto table = measured ? ranges::TableOf(played, measured->ranges,
                                            {.participants = {context_.session.participant},
                                             .when = text::Utc(clock::WallNs()),
                                             .how = "live",
                                             .by = "footing-study " + context_.options.version,
                                             .simulated = measured->simulated},
                                            *built_in)
                          : Result<ordered_json>(measured.error());
    if (table) {
      context_.console.Print("Measured: " + (*table)["measured"]["ranges"].dump());
      return NoteTable(interface, kByMeasurement, table->dump(), "");
    }
    context_.console.Print(table.error().message);
    const auto next = context_.console.Ask(
        "Press Enter to measure again, or type b to go on without own ranges:");
    if (!next) return next.error();
    if (next->empty()) continue;
    if (*next != "b") {
      context_.console.Print(text::Quoted(*next) + " is neither; measuring again");
      continue;
    }
    const auto given = context_.options.tables.find(interface);
    const bool protocol = given != context_.options.tables.end();
    return NoteTable(interface, protocol ? kByProtocol : kByBuiltIn, protocol ? given->second : "",
                     table.error().message);
  }
}

}  // namespace footing::study
