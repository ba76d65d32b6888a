#include "clients/log/commands.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "clients/log/export_bids.h"
#include "clients/log/export_bodies.h"
#include "clients/log/export_csv.h"
#include "clients/log/export_xdf.h"
#include "clients/log/output_folder.h"
#include "clients/log/record.h"
#include "common/body/angle_deviation.h"
#include "common/cli/cli.h"
#include "common/recording/repair.h"
#include "common/base/json_text.h"
#include "common/net/address.h"

namespace footing::log_client {
namespace {

using nlohmann::ordered_json;

/// The entry of a list on one line: "path a/b.csv  rows 7".
std::string EntryLine(const ordered_json& entry) {
  std::string line = " ";
  for (const auto& [name, value] : entry.items()) {
    line += " " + name + " " + (value.is_string() ? value.get<std::string>() : value.dump()) + " ";
  }
  line.pop_back();
  return line;
}

/// One JSON object, or one "name: value" line each, a list with a line for each entry.
void Print(const ordered_json& out, bool json) {
  if (json) {
    std::cout << text::ToText(out) << std::endl;
    return;
  }
  for (const auto& [name, value] : out.items()) {
    if (value.is_array()) {
      std::cout << name << ":" << std::endl;
      for (const ordered_json& entry : value) std::cout << EntryLine(entry) << std::endl;
      continue;
    }
    std::cout << name << ": " << (value.is_string() ? value.get<std::string>() : value.dump())
              << std::endl;
  }
}

Result<ordered_json> RunRecord(RecordOptions options, const std::vector<std::string>& addresses) {
  for (const std::string& text : addresses) {
    const Result<transport::Address> address = transport::ParseAddress(text);
    if (!address) return address.error();
    const bool again = std::any_of(
        options.addresses.begin(), options.addresses.end(),
        [&](const transport::Address& other) { return other.Text() == address->Text(); });
    if (again)
      return UsageError("--connect " + text + " is named twice: each message would be, too");
    options.addresses.push_back(*address);
  }
  if (addresses.empty()) {
    options.addresses = {transport::DefaultAddress("sensor"),
                         transport::DefaultAddress("simulation")};
  }
  options.version = cli::Version();
  const Result<RecordReport> report = Record(options);
  if (!report) return report.error();
  return ordered_json{{"file", options.out},
                      {"messages", report->messages},
                      {"ticks", report->ticks},
                      {"missing_ticks", report->missing_ticks},
                      {"duration_s", report->duration_s}};
}

std::optional<BodyFormat> BodyFormatOf(const std::string& format) {
  if (format == "bvh") return BodyFormat::kBvh;
  if (format == "trc") return BodyFormat::kTrc;
  if (format == "mot") return BodyFormat::kMot;
  if (format == "c3d") return BodyFormat::kC3d;
  return std::nullopt;
}

Result<ordered_json> RunBodies(const std::string& file, const std::string& format, BodyFormat body,
                               const std::string& folder, bool replace) {
  const auto motions = ExportBodies(file, folder, body, replace);
  if (!motions) return motions.error();
  ordered_json out{{"file", file}, {"format", format}, {"files", ordered_json::array()}};
  for (const ExportedMotion& motion : *motions) {
    out["files"].push_back({{"path", motion.path},
                            {"subject", motion.subject},
                            {"frames", motion.frames},
                            {"invalid_frames", motion.invalid_frames},
                            {"rate_hz", motion.rate_hz},
                            {"begin_s", motion.begin_s},
                            {"angle_errors", motion.angle_errors}});
  }
  out["angle_sd_source"] = body::AngleDeviationSource();
  out["angle_sd"] = ordered_json::array();
  for (const body::AngleDeviation& one : body::CoordinateDeviations()) {
    out["angle_sd"].push_back(
        {{"coordinate", one.name}, {"upright_deg", one.upright_deg}, {"bent_deg", one.bent_deg}});
  }
  return out;
}

Result<ordered_json> RunXdf(const std::string& file, const std::string& folder, bool replace) {
  const auto exported = ExportXdf(file, folder, replace);
  if (!exported) return exported.error();
  ordered_json out{{"file", file},
                   {"format", "xdf"},
                   {"files", {{{"path", exported->path}}}},
                   {"streams", ordered_json::array()}};
  for (const ExportedStream& stream : exported->streams) {
    out["streams"].push_back(
        {{"name", stream.name}, {"channels", stream.channels}, {"samples", stream.samples}});
  }
  return out;
}

Result<ordered_json> RunBids(const std::string& file, const std::string& folder,
                             const BidsOptions& options) {
  const auto exported = ExportBids(file, folder, options);
  if (!exported) return exported.error();
  ordered_json out{{"file", file},
                   {"format", "bids"},
                   {"files", ordered_json::array()},
                   {"events", exported->events}};
  for (const ExportedTable& table : exported->tables) {
    out["files"].push_back({{"path", table.path},
                            {"tracking_system", table.tracking_system},
                            {"channels", table.channels},
                            {"samples", table.samples}});
  }
  return out;
}

Result<ordered_json> RunExport(const std::string& file, const std::string& format,
                               const std::string& folder, const BidsOptions& of_bids) {
  if (format == "bids") return RunBids(file, folder, of_bids);
  if (!of_bids.subject.empty() || !of_bids.task.empty()) {
    return UsageError("--subject and --task need --format bids");
  }
  const bool replace = of_bids.replace;
  if (const auto body = BodyFormatOf(format)) {
    return RunBodies(file, format, *body, folder, replace);
  }
  if (format == "xdf") return RunXdf(file, folder, replace);
  if (format != "csv") {
    return UsageError("unknown --format " + format +
                      "; there are: csv, xdf, bids, bvh, trc, mot, c3d");
  }
  const auto files = ExportCsv(file, folder, replace);
  if (!files) return files.error();
  ordered_json out{{"file", file}, {"format", format}, {"files", ordered_json::array()}};
  for (const ExportedFile& exported : *files) {
    out["files"].push_back(
        {{"topic", exported.topic}, {"path", exported.path}, {"rows", exported.rows}});
  }
  return out;
}

Result<ordered_json> RunRepair(const std::string& in, const std::string& out, bool replace) {
  const auto report =
      recording::Repair(in, out, std::string("footing-log ") + cli::Version(), replace);
  if (!report) return report.error();
  const mcap::WalkEnd& found = report->found;
  return ordered_json{
      {"input", in},
      {"output", out},
      {"was_complete", found.complete},
      {"problem", found.problem},
      {"problem_byte", found.problem_offset},
      {"messages_kept", report->messages},
      {"attachments_kept", report->attachments},
      {"metadata_kept", report->metadata},
      {"damaged_chunks_lost", found.damaged_chunks},
      {"damaged_records_lost", found.damaged_records},
      {"skipped_bytes", found.skipped_bytes},
      {"missing_ticks", report->missing_ticks},
      {"bytes_behind_last_complete_record", report->input_bytes - found.end_offset}};
}

}  // namespace

void Finish(const Result<ordered_json>& result, Shared& shared) {
  if (result) {
    Print(*result, shared.json);
  } else {
    shared.exit_code = cli::Report(result.error());
  }
}

void AddRecordCommand(CLI::App& app, Shared& shared) {
  CLI::App* command =
      app.add_subcommand("record", "Record the messages of servers to an MCAP file");
  const auto options = std::make_shared<RecordOptions>();
  const auto addresses = std::make_shared<std::vector<std::string>>();
  command->add_option(
      "--connect", *addresses,
      "Address of a server, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT; may be repeated (default: "
      "this user's sensor and simulation servers)");
  command->add_option("--out", options->out, "Output file, MCAP")->required();
  command->add_option("--seconds", options->seconds, "Duration, s (default: until SIGINT)")
      ->check(CLI::Range(0.1, 1e6));
  command->add_option(
      "--attach", options->attachments,
      "File to store in the recording, such as a config or a track; may be repeated");
  command->add_flag(
      "--from-ring", options->from_ring,
      "Begin with what the servers still hold of the last 30 s, needed to replay a whole session");
  command->add_flag("--force", options->replace, "Overwrite an existing file");
  command->callback(
      [options, addresses, &shared] { Finish(RunRecord(*options, *addresses), shared); });
}

void AddExportCommand(CLI::App& app, Shared& shared) {
  CLI::App* command =
      app.add_subcommand("export", "Write the messages of a recording in other formats");
  const auto file = std::make_shared<std::string>();
  const auto format = std::make_shared<std::string>();
  const auto folder = std::make_shared<std::string>();
  const auto of_bids = std::make_shared<BidsOptions>();
  of_bids->version = cli::Version();
  command->add_option("FILE", *file, "Recording, MCAP file")->required();
  command
      ->add_option(
          "--format", *format,
          "Output format: csv, xdf (Lab Streaming Layer), bids (a subject's task in a data set), "
          "or of reconstructed bodies bvh "
          "(rotations), trc (joint centres), "
          "mot (joint angles and forces under the feet, for OpenSim) or c3d (joint centres and "
          "forces under the feet)")
      ->required();
  command
      ->add_option("--out", *folder,
                   "Output folder; one file (xdf), or one per topic (csv) or subject (others; mot: "
                   "two; beside them the stated errors of the angles); with bids the data set, "
                   "created if it does not exist")
      ->required();
  command->add_option("--subject", of_bids->subject,
                      "With bids: label of the subject, letters and digits (default 01)");
  command->add_option(
      "--task", of_bids->task,
      "With bids: label of the task, letters and digits (default: the file's name)");
  command->add_flag("--force", of_bids->replace, "Overwrite existing files");
  command->callback([=, &shared] {
    Finish(RunExport(*file, *format, WithoutEndSlashes(*folder), *of_bids), shared);
  });
}

void AddRepairCommand(CLI::App& app, Shared& shared) {
  CLI::App* command =
      app.add_subcommand("repair", "Write a complete recording from a truncated or damaged one");
  const auto in = std::make_shared<std::string>();
  const auto out = std::make_shared<std::string>();
  const auto replace = std::make_shared<bool>(false);
  command->add_option("IN", *in, "Truncated or damaged recording, MCAP file")->required();
  command->add_option("--out", *out, "Output file, MCAP")->required();
  command->add_flag("--force", *replace, "Overwrite an existing file");
  command->callback([=, &shared] { Finish(RunRepair(*in, *out, *replace), shared); });
}

}  // namespace footing::log_client
