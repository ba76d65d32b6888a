#include "clients/log/commands.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <nlohmann/json.hpp>

#include "clients/log/align.h"
#include "clients/log/contents.h"
#include "clients/log/export_bodies.h"
#include "clients/log/export_xdf.h"
#include "clients/log/foxglove.h"
#include "clients/log/osc_out.h"
#include "clients/log/record.h"
#include "clients/log/smoothed.h"
#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/angle_deviation.h"
#include "common/camera/camera_pose.h"
#include "common/cli/cli.h"
#include "common/frames/camera_file.h"
#include "common/net/address.h"
#include "common/recording/mcap_reader.h"
#include "common/recording/mcap_writer.h"
#include "common/recording/recording_server.h"
#include "common/recording/recording_writer.h"
#include "common/recording/repair.h"
#include "common/recording/stream_recorder.h"
#include "common/runtime/clock.h"
#include "common/runtime/files.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"
#include "common/wire/wire.h"
#include "footing/v1/sensor.pb.h"

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
  auto parsed = RecordedAddresses(addresses);
  if (!parsed) return parsed.error();
  options.addresses = std::move(*parsed);
  options.version = cli::Version();
  const Result<RecordReport> report = Record(options);
  if (!report) return report.error();
  ordered_json out{{"file", options.out},
                   {"messages", report->messages},
                   {"ticks", report->ticks},
                   {"missing_ticks", report->missing_ticks},
                   {"duration_s", report->duration_s}};
  if (!options.lsl.empty()) {
    out["lsl_streams"] = report->lsl_streams;
    out["lsl_samples"] = report->lsl_samples;
  }
  return out;
}

std::optional<BodyFormat> BodyFormatOf(const std::string& format) {
  if (format == "bvh") return BodyFormat::kBvh;
  if (format == "trc") return BodyFormat::kTrc;
  if (format == "mot") return BodyFormat::kMot;
  if (format == "c3d") return BodyFormat::kC3d;
  if (format == "gltf") return BodyFormat::kGltf;
  return std::nullopt;
}

/// The options of an export besides its format.
struct ExportOptions {
  BidsOptions bids;
  std::string skeleton;
  bool tidy = false;
  std::optional<int> lag_ms;
};

/// Lag of the poses of an exported body, ms, where no other one is named.
constexpr int kExportLagMs = 200;

Result<ordered_json> RunBodies(const std::string& file, const std::string& format, BodyFormat body,
                               const std::string& folder, const ExportOptions& options) {
  const int lag_ms = options.lag_ms.value_or(kExportLagMs);
  const SmoothedCopy copy(file, lag_ms, folder);
  const auto motions =
      ExportBodies(copy.path(), folder, body, options.bids.replace,
                   options.skeleton == "humanoid" ? BvhSkeleton::kHumanoid : BvhSkeleton::kCmu);
  if (!motions) return motions.error();
  ordered_json out{{"file", file}, {"format", format}, {"files", ordered_json::array()}};
  if (copy.path() != file) out["smoothed_ms"] = lag_ms;
  if (!copy.why_live().empty()) out["not_smoothed"] = copy.why_live();
  for (const ExportedMotion& motion : *motions) {
    out["files"].push_back({{"path", motion.path},
                            {"subject", motion.subject},
                            {"frames", motion.frames},
                            {"invalid_frames", motion.invalid_frames},
                            {"rate_hz", motion.rate_hz},
                            {"begin_s", motion.begin_s},
                            {"angle_errors", motion.angle_errors}});
  }
  const bool has_errors = std::any_of(motions->begin(), motions->end(), [](const auto& motion) {
    return !motion.angle_errors.empty();
  });
  if (!has_errors) return out;
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
    out["streams"].push_back({{"name", stream.name},
                              {"channels", stream.channels},
                              {"samples", stream.samples},
                              {"mended_times", stream.mended_times}});
  }
  return out;
}

Result<ordered_json> RunFoxglove(const std::string& file, const std::string& folder, bool replace) {
  const auto exported =
      ExportFoxglove(file, folder, std::string("footing-log ") + cli::Version(), replace);
  if (!exported) return exported.error();
  ordered_json out{{"file", file},
                   {"format", "foxglove"},
                   {"files", {{{"path", exported->path}}}},
                   {"topics", ordered_json::array()}};
  for (const FoxgloveTopic& topic : exported->topics) {
    out["topics"].push_back(
        {{"topic", topic.topic}, {"schema", topic.schema}, {"messages", topic.messages}});
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
                            {"samples", table.samples},
                            {"mended_times", table.mended_times}});
  }
  return out;
}

Result<ordered_json> RunExport(const std::string& file, const std::string& format,
                               const std::string& folder, const ExportOptions& options) {
  const BidsOptions& of_bids = options.bids;
  const bool tidy = options.tidy;
  const auto body = BodyFormatOf(format);
  if (tidy && format != "csv") return UsageError("--tidy needs --format csv");
  if (!options.skeleton.empty() && format != "bvh") {
    return UsageError("--skeleton needs --format bvh");
  }
  if (options.lag_ms && !body) {
    return UsageError("--lag-ms needs --format bvh, trc, mot, c3d or gltf");
  }
  if (format == "bids") return RunBids(file, folder, of_bids);
  if (!of_bids.subject.empty() || !of_bids.task.empty()) {
    return UsageError("--subject and --task need --format bids");
  }
  const bool replace = of_bids.replace;
  if (body) return RunBodies(file, format, *body, folder, options);
  if (format == "xdf") return RunXdf(file, folder, replace);
  if (format == "foxglove") return RunFoxglove(file, folder, replace);
  if (format != "csv") {
    return UsageError("unknown --format " + format +
                      "; there are: csv, xdf, bids, foxglove, bvh, trc, mot, c3d, gltf");
  }
  const auto files = ExportCsv(file, folder, replace, tidy);
  if (!files) return files.error();
  ordered_json out{{"file", file}, {"format", format}, {"files", ordered_json::array()}};
  for (const ExportedFile& exported : *files) {
    out["files"].push_back({{"topic", exported.topic},
                            {"path", exported.path},
                            {"rows", exported.rows},
                            {"mended_times", exported.mended_times}});
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
  command->add_option("--lsl", options->lsl,
                      "Record the streams of the Lab Streaming Layer that match this query, too; "
                      "may be repeated, such as --lsl \"type='EEG'\"");
  command->add_option(
      "--attach", options->attachments,
      "File to store in the recording, such as a config or a track; may be repeated");
  command->add_flag(
      "--from-ring", options->from_ring,
      "Begin with what the servers still hold of the last 30 s, needed to replay a whole session");
  const auto compression = std::make_shared<std::string>("zstd");
  command
      ->add_option("--compression", *compression,
                   "Of the file's chunks: zstd or none, for readers that do not know it (default "
                   "zstd)")
      ->check(CLI::IsMember({"zstd", "none"}));
  command->add_flag("--foxglove", options->foxglove,
                    "Add topics that Foxglove and Lichtblick draw in 3-D without a plug-in");
  command->add_flag("--force", options->replace, "Overwrite an existing file");
  command->footer(
      "Examples:\n"
      "  footing-log record --out a.mcap --seconds 60\n"
      "  footing-log record --out a.mcap --foxglove\n"
      "  footing-log record --out a.mcap --lsl \"type='EEG'\" --lsl \"name='PsychoPy'\"");
  command->callback([options, addresses, compression, &shared] {
    options->compress = *compression == "zstd";
    Finish(RunRecord(*options, *addresses), shared);
  });
}

void AddExportCommand(CLI::App& app, Shared& shared) {
  CLI::App* command =
      app.add_subcommand("export", "Write the messages of a recording in other formats");
  const auto file = std::make_shared<std::string>();
  const auto format = std::make_shared<std::string>();
  const auto folder = std::make_shared<std::string>();
  const auto options = std::make_shared<ExportOptions>();
  options->bids.version = cli::Version();
  command->add_option("FILE", *file, "Recording, MCAP file")->required();
  command
      ->add_option(
          "--format", *format,
          "Output format: csv, xdf (Lab Streaming Layer), bids (a subject's task in a data set), "
          "foxglove (the recording with topics that Foxglove and Lichtblick draw in 3-D), "
          "or of reconstructed bodies and the biped bvh "
          "(rotations), trc (joint centres), "
          "mot (joint angles and forces under the feet, external loads and a model, for OpenSim), "
          "c3d "
          "(joint centres and forces under the feet) or gltf (an animated figure, .glb)")
      ->required();
  command
      ->add_option("--out", *folder,
                   "Output folder; one file (xdf, foxglove), or one per topic (csv) or subject "
                   "(others; mot: "
                   "two; beside them the stated errors of the angles); with bids the data set, "
                   "created if it does not exist")
      ->required();
  command->add_option("--subject", options->bids.subject,
                      "With bids: label of the subject, letters and digits (default 01)");
  command->add_option(
      "--task", options->bids.task,
      "With bids: label of the task, letters and digits (default: the file's name)");
  command
      ->add_option("--skeleton", options->skeleton,
                   "With bvh: cmu (joints named as CMU's, as recorded; default) or humanoid (a "
                   "T-pose at rest and the names of Unity's human bones)")
      ->check(CLI::IsMember({"cmu", "humanoid"}));
  command->add_flag("--tidy", options->tidy,
                    "With csv: fewer columns, named by joint with the unit last, and a codebook");
  command
      ->add_option("--lag-ms", options->lag_ms,
                   "Of reconstructed bodies: time after a pose that it may use, ms: 0 (as it was "
                   "live), 100 or 200 (default 200)")
      ->check(CLI::IsMember({0, 100, 200}));
  command->add_flag("--force", options->bids.replace, "Overwrite existing files");
  command->callback([=, &shared] {
    Finish(RunExport(*file, *format, WithoutEndSlashes(*folder), *options), shared);
  });
}

namespace {

ordered_json Maybe(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json();
}

ordered_json ToJson(const AlignOptions& options, const Alignment& alignment) {
  const TimeOffset none;
  const TimeOffset& at = alignment.offset ? *alignment.offset : none;
  const bool known = alignment.method == "marker" || alignment.method == "lsl";
  ordered_json out{{"file", options.file}, {"with", options.with}, {"method", alignment.method}};
  out["sure"] = at.sure;
  out["offset_s"] = alignment.offset ? ordered_json(at.offset_s) : ordered_json();
  out["sd_s"] = alignment.offset ? ordered_json(at.sd_s) : ordered_json();
  out["doubt"] = alignment.offset ? at.doubt
                                  : "there is no second in which both forces change: the files do "
                                    "not overlap, or nobody moved";
  out["note"] = alignment.note;
  if (alignment.offset && !known) {
    out["correlation"] = at.correlation;
    out["overlap_s"] = at.overlap_s;
    out["gain"] = at.gain;
    out["misfit_n"] = at.misfit_n;
    out["play_n"] = at.play_n;
    out["evidence"] = at.evidence;
    out["runner_up_s"] = Maybe(at.runner_up_s);
    out["runner_up_evidence"] = at.runner_up_evidence;
  }
  if (alignment.files.empty()) return out;
  out["files"] = alignment.files;
  out["frames"] = alignment.frames;
  out["unmeasured_frames"] = alignment.unmeasured_frames;
  out["placement_rms_m"] = Maybe(alignment.placement_rms_m);
  out["missing"] = {"shear forces", "free moments"};
  return out;
}

void PrintText(const AlignOptions& options, const Alignment& alignment) {
  if (!alignment.note.empty()) std::cout << "note: " << alignment.note << "\n";
  if (!alignment.offset) {
    std::cout << "not sure: there is no second in which both forces change: the files do not "
                 "overlap, or nobody moved\n";
    return;
  }
  const TimeOffset& at = *alignment.offset;
  std::cout << "time in " << options.file << " = time in " << options.with
            << (at.offset_s < 0 ? " - " : " + ") << text::Fixed(std::abs(at.offset_s), 4)
            << " s, standard deviation " << text::Fixed(1e3 * at.sd_s, 1) << " ms\n"
            << (at.sure ? "sure" : "not sure: " + at.doubt) << "\n";
  if (alignment.files.empty()) return;
  for (const std::string& file : alignment.files) std::cout << "wrote " << file << "\n";
  std::cout << alignment.frames << " frames, " << alignment.unmeasured_frames
            << " of them without a board; shear forces and free moments are missing; "
            << (alignment.placement_rms_m
                    ? "the feet are within " + text::Fixed(100 * *alignment.placement_rms_m, 1) +
                          " cm of where the boards were pressed"
                    : "the places are in the boards' own frame")
            << "\n";
}

void RunAlign(const AlignOptions& options, Shared& shared) {
  if (options.at_s && options.marker.empty()) {
    return Finish(UsageError("--at needs --marker"), shared);
  }
  const auto alignment = Align(options);
  if (!alignment) return Finish(alignment.error(), shared);
  if (shared.json) {
    std::cout << text::ToText(ToJson(options, *alignment)) << std::endl;
  } else {
    PrintText(options, *alignment);
    std::cout.flush();
  }
  if (alignment->offset && alignment->offset->sure) return;
  shared.exit_code = static_cast<int>(ErrorKind::kFailure);
}

}  // namespace

void AddAlignCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand(
      "align", "Find the offset between a recording and a file of another motion-capture system");
  const auto options = std::make_shared<AlignOptions>();
  const auto clock = std::make_shared<std::string>("force");
  command->add_option("FILE", options->file, "Recording with boards, MCAP file")->required();
  command
      ->add_option("--with", options->with,
                   "File of the other system: .c3d (plates or markers), .trc, .mot, .sto, or .csv "
                   "with the columns time_s,force_n")
      ->required();
  command->add_option("--rig", options->rig, "Rig of the boards (default: the first one)");
  command
      ->add_option("--clock", *clock,
                   "force (compare vertical forces; default) or lsl (the file's times are LSL's "
                   "clock on the host of footingd)")
      ->check(CLI::IsMember({"force", "lsl"}));
  command->add_option("--marker", options->marker,
                      "Align by this marker of the recording, and by --at or a C3D event of that "
                      "label");
  command->add_option("--at", options->at_s, "Time of the marker in the file, s");
  command
      ->add_option_function<double>(
          "--max-sd-ms", [options](double ms) { options->most_sd_s = ms / 1e3; },
          "Greatest standard deviation of a sure offset, ms (default 5)")
      ->check(CLI::Range(0.1, 100.0));
  command->add_option("--out", options->out,
                      "Folder for the boards' ground forces on the file's clock, if it is sure: "
                      "NAME_grf.mot and NAME_loads.xml, for OpenSim");
  command->add_flag("--force", options->replace, "Overwrite existing files");
  command->footer(
      "Examples:\n"
      "  footing-log align a.mcap --with squats.c3d\n"
      "  footing-log align a.mcap --with opencap.trc --out opensim/\n"
      "  footing-log align a.mcap --with video.trc --marker clap --at 3.42\n"
      "Exit code 1 if the offset is not sure.");
  command->callback([options, clock, &shared] {
    options->lsl_clock = *clock == "lsl";
    if (!options->out.empty()) options->out = WithoutEndSlashes(options->out);
    RunAlign(*options, shared);
  });
}

void AddOscCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand(
      "osc", "Send the characters of footing-sim to programs for avatars and sound, live");
  const auto options = std::make_shared<OscOptions>();
  const auto address = std::make_shared<std::string>();
  const auto format = std::make_shared<std::string>("vmc");
  command
      ->add_option("--to", options->to,
                   "UDP address of a receiver, HOST:PORT; may be repeated (VMC's own port is "
                   "39539)")
      ->required();
  command
      ->add_option("--format", *format,
                   "vmc (bones of an avatar, for VSeeFace, Warudo, Unity and others; default) or "
                   "osc (places of all links, /footing/character/...)")
      ->check(CLI::IsMember({"vmc", "osc"}));
  command->add_option("--connect", *address,
                      "Address of footing-sim (default: this user's simulation server)");
  command->add_option("--rate-hz", options->rate_hz, "Frames a second, at most (default 60)")
      ->check(CLI::Range(1.0, 120.0));
  command->add_option("--seconds", options->seconds, "Duration, s (default: until SIGINT)")
      ->check(CLI::Range(0.1, 1e6));
  command->callback([=, &shared] {
    const auto run = [&]() -> Result<ordered_json> {
      const auto from = transport::AddressOrDefault(*address, "simulation");
      if (!from) return from.error();
      options->from = *from;
      options->format = *format == "vmc" ? OscFormat::kVmc : OscFormat::kPlain;
      const auto report = SendOsc(*options);
      if (!report) return report.error();
      return ordered_json{{"frames", report->frames},
                          {"packets", report->packets},
                          {"bytes", report->bytes},
                          {"refused_packets", report->refused},
                          {"longest_gap_s", report->longest_gap_s}};
    };
    Finish(run(), shared);
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

namespace {

double SecondsBetween(std::uint64_t from_ns, std::uint64_t to_ns) {
  return to_ns <= from_ns ? 0 : NanosecondsToSeconds(static_cast<std::int64_t>(to_ns - from_ns));
}

ordered_json ToJson(const Contents& contents) {
  ordered_json out{
      {"file", contents.path},
      {"bytes", contents.bytes},
      {"complete", contents.end.complete},
      {"library", contents.library},
      {"messages", contents.messages},
      {"start_ns", contents.start_ns},
      {"end_ns", contents.end_ns},
      {"duration_s", SecondsBetween(contents.start_ns, contents.end_ns)},
      {"simulated", contents.simulated ? ordered_json(*contents.simulated) : ordered_json(nullptr)},
      {"gaps", contents.gaps},
      {"missing_ticks", contents.missing_ticks},
      {"missing_s", contents.missing_s},
      {"restarts", contents.restarts},
      {"restart_s", contents.restart_s}};
  if (!contents.end.complete) {
    out["problem"] = contents.end.problem;
    out["problem_byte"] = contents.end.problem_offset;
  }
  out["topics"] = ordered_json::array();
  for (const Topic& topic : contents.topics) {
    out["topics"].push_back({{"topic", topic.name},
                             {"schema", topic.schema},
                             {"messages", topic.messages},
                             {"rate_hz", topic.RateHz()},
                             {"start_s", SecondsBetween(contents.start_ns, topic.first_ns)},
                             {"end_s", SecondsBetween(contents.start_ns, topic.last_ns)}});
  }
  out["configs"] = ordered_json::array();
  for (const std::string& config : contents.configs) {
    auto parsed = ordered_json::parse(config, nullptr, /*allow_exceptions=*/false);
    out["configs"].push_back(parsed.is_discarded() ? ordered_json() : std::move(parsed));
  }
  out["attachments"] = ordered_json::array();
  for (const AttachmentNote& attachment : contents.attachments) {
    out["attachments"].push_back({{"name", attachment.name},
                                  {"media_type", attachment.media_type},
                                  {"bytes", attachment.bytes}});
  }
  out["metadata"] = ordered_json::array();
  for (const mcap::Metadata& metadata : contents.metadata) {
    out["metadata"].push_back({{"name", metadata.name}, {"values", metadata.values}});
  }
  return out;
}

/// One line of what stands out in an effective config; its values are printed with --json.
void PrintConfig(const std::string& text) {
  using Path = ordered_json::json_pointer;
  const ordered_json config = ordered_json::parse(text, nullptr, /*allow_exceptions=*/false);
  const auto word = [&](const char* path) {
    const Path place(path);
    const ordered_json value = config.contains(place) ? config[place] : ordered_json("?");
    return value.is_string() ? value.get<std::string>() : value.dump();
  };
  std::cout << "  ran with: " << word("/program") << " " << word("/version") << ", engine "
            << word("/engine");
  if (config.contains(Path("/interface/name"))) {
    const std::string interface = word("/interface/name");
    std::cout << ", interface "
              << interface << (interface == "leg" ? " turned by " + word("/interface/turn_by") : "")
              << ", its table: " << word("/interface/table_by");
  }
  if (config.contains(Path("/interface/table/measured"))) {
    std::cout << ", measured of " << word("/interface/table/measured/participants");
  }
  std::cout << " (all values: --json)\n";
}

/// Ticks that are missing, and the time in which there were none.
std::string LossLine(const Contents& contents) {
  std::string line = "gaps: " + std::to_string(contents.gaps) +
                     ", ticks missing: " + std::to_string(contents.missing_ticks);
  if (contents.missing_ticks > 0) line += " (" + text::Fixed(contents.missing_s, 2) + " s)";
  if (contents.restarts > 0) {
    line += ", and " + text::Fixed(contents.restart_s, 2) + " s without ticks over " +
            std::to_string(contents.restarts) + " server restart" +
            (contents.restarts == 1 ? "" : "s");
  }
  return line;
}

void PrintText(const Contents& contents) {
  std::cout << contents.path << ": " << contents.bytes << " bytes, written by " << contents.library
            << "\n"
            << (contents.end.complete ? "complete" : "NOT COMPLETE: " + contents.end.problem)
            << ", " << text::Fixed(SecondsBetween(contents.start_ns, contents.end_ns), 1) << " s, "
            << contents.messages << " messages, "
            << (!contents.simulated   ? "not said whether simulated"
                : *contents.simulated ? "SIMULATED"
                                      : "real devices")
            << "\n"
            << LossLine(contents) << "\n";
  for (const Topic& topic : contents.topics) {
    std::cout << "  " << topic.name << "  " << topic.messages
              << (topic.messages == 1 ? " message  " : " messages  ");
    if (topic.RateHz() > 0) std::cout << text::Fixed(topic.RateHz(), 1) << " Hz  ";
    std::cout << topic.schema << "\n";
  }
  for (const std::string& config : contents.configs) PrintConfig(config);
  for (const AttachmentNote& attachment : contents.attachments) {
    std::cout << "  attached: " << attachment.name << " (" << attachment.bytes << " bytes)\n";
  }
  for (const mcap::Metadata& metadata : contents.metadata) {
    std::cout << "  " << metadata.name << ":";
    for (const auto& [key, value] : metadata.values) {
      const bool is_line = value.find('\n') == std::string::npos;
      std::cout << " " << key << "="
                << (is_line ? value : "(" + std::to_string(value.size()) + " bytes: --json)");
    }
    std::cout << "\n";
  }
  std::cout.flush();
}

}  // namespace

void AddInfoCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand("info", "Print the contents of a recording");
  const auto file = std::make_shared<std::string>();
  command->add_option("FILE", *file, "Recording, MCAP file")->required();
  command->callback([file, &shared] {
    const Result<Contents> contents = ReadContents(*file);
    if (!contents) {
      shared.exit_code = cli::Report(contents.error());
      return;
    }
    if (shared.json) {
      std::cout << text::ToText(ToJson(*contents)) << std::endl;
    } else {
      PrintText(*contents);
    }
    if (const auto incomplete = Incomplete(*file, contents->end)) {
      shared.exit_code = cli::Report(*incomplete);
    }
  });
}

namespace {

struct RecalibrateOptions {
  std::string in, out, camera;
  std::string tracker = "camera";
  bool replace = false;
};

Result<ordered_json> RunRecalibrate(const RecalibrateOptions& options) {
  const auto camera = frames::ReadCameraFile(options.camera);
  if (!camera) return camera.error();
  if (!camera->X_WC)
    return InvalidData(options.camera +
                       " does not say where the camera is (position_W_m, rotation_WC): calibrate "
                       "it with footing-ctl setup --only camera");
  const auto report = Recalibrate(options.in, options.out, options.tracker, *camera->X_WC,
                                  std::string("footing-log ") + cli::Version(), options.replace);
  if (!report) return report.error();
  return ordered_json{{"input", options.in},
                      {"output", options.out},
                      {"messages", report->messages},
                      {"samples_recalibrated", report->samples},
                      {"samples_unchanged", report->untouched}};
}

}  // namespace

void AddRecalibrateCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand(
      "recalibrate", "Write a copy of a recording with a new calibration applied to its hands");
  const auto options = std::make_shared<RecalibrateOptions>();
  command->add_option("IN", options->in, "Recording, MCAP file")->required();
  command->add_option("--camera", options->camera, "Camera file with the new pose, JSON")
      ->required();
  command->add_option("--out", options->out, "Output file, MCAP")->required();
  command->add_option("--tracker", options->tracker, "Name of the tracker (default camera)");
  command->add_flag("--force", options->replace, "Overwrite an existing file");
  command->callback([options, &shared] { Finish(RunRecalibrate(*options), shared); });
}

namespace {

struct ServeOptions {
  std::string file;
  std::string server;
  std::vector<std::string> addresses;
};

/// The server whose place is taken: the one asked for, else footingd, else the only one.
Result<std::string> ChooseServer(const recording::RecordedSession& session,
                                 const std::string& wanted) {
  std::string names;
  std::string first;
  for (const recording::RecordedServer& server : session.servers()) {
    if (server.ticks.empty()) continue;
    if (server.name == wanted || (wanted.empty() && server.name == "footingd")) return server.name;
    if (first.empty()) first = server.name;
    names += (names.empty() ? "" : ", ") + server.name;
  }
  if (first.empty()) return InvalidData(session.path() + " holds no ticks of a server");
  if (wanted.empty()) return first;
  return UsageError(session.path() + " has no messages of " + wanted + "; there are: " + names);
}

Result<nlohmann::ordered_json> RunServe(const ServeOptions& options) {
  const auto session = recording::RecordedSession::Open(options.file);
  if (!session) return session.error();
  const auto name = ChooseServer(*session, options.server);
  if (!name) return name.error();
  boost::asio::io_context io(1);
  playback::RecordingServer server(io, *session, *name, cli::Version());
  std::vector<transport::Address> addresses;
  for (const std::string& text : options.addresses) {
    const auto address = transport::ParseAddress(text);
    if (!address) return address.error();
    addresses.push_back(*address);
  }
  if (addresses.empty()) {
    const bool simulation = name->starts_with("footing-sim");
    addresses.push_back(transport::DefaultAddress(simulation ? "simulation" : "sensor", true));
  }
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    if (const auto listening = server.Listen(addresses[i]); !listening) return listening.error();
    std::cerr << "serving " << *name << " of " << options.file << ", " << server.duration_s()
              << " s, on " << server.ListeningOn(i).Text() << " once a client connects"
              << std::endl;
  }
  Result<void> ended;
  bool complete = false;
  service_manager::ProgramEnd end(io, [&] { server.Stop("footing-log is being stopped"); });
  server.Start([&](const Result<void>& result) {
    ended = result;
    complete = result.ok();
    server.Stop(result ? "the recording has ended" : result.error().message);
    end.cancel();
  });
  io.run();
  if (!ended) return InvalidData(options.file + ": " + ended.error().message);
  return nlohmann::ordered_json{{"file", options.file},
                                {"server", *name},
                                {"ticks", server.published()},
                                {"duration_s", server.duration_s()},
                                {"complete", complete}};
}

}  // namespace

void AddServeCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand(
      "serve", "Serve a recording in place of the recorded server, at its recorded times");
  const auto options = std::make_shared<ServeOptions>();
  command->add_option("FILE", options->file, "Recording, MCAP file")->required();
  command->add_option("--listen", options->addresses,
                      "Address to listen on, unix:PATH or tcp:HOST:PORT; may be repeated (default: "
                      "that of the server)");
  command->add_option("--server", options->server,
                      "Server of the recording: footingd or footing-sim (default: footingd)");
  command->callback([options, &shared] { Finish(RunServe(*options), shared); });
}

namespace {

constexpr char kHandSchema[] = "footing.v1.HandSamples";

bool IsChanged(const v1::HandSample& sample, const std::string& tracker) {
  return sample.tracker() == tracker && sample.has_tracker_pose();
}

/// Counts the hands that a Copier would change.
class Counter {
 public:
  explicit Counter(const std::string& tracker) : tracker_(tracker) {}

  mcap::Visitor Visitor() {
    mcap::Visitor visitor;
    visitor.schema = [this](const mcap::Schema& schema) {
      if (schema.name == kHandSchema) schemas_.insert(schema.id);
    };
    visitor.channel = [this](const mcap::Channel& channel) {
      if (schemas_.contains(channel.schema_id)) channels_.insert(channel.id);
    };
    visitor.message = [this](const mcap::Message& message) {
      v1::HandSamples hands;
      if (!channels_.contains(message.channel_id) ||
          !hands.ParseFromArray(message.data.data(), static_cast<int>(message.data.size()))) {
        return;
      }
      for (const v1::HandSample& sample : hands.samples()) {
        samples_ += IsChanged(sample, tracker_) ? 1 : 0;
      }
    };
    return visitor;
  }

  std::uint64_t samples() const { return samples_; }

 private:
  const std::string tracker_;
  std::set<std::uint16_t> schemas_, channels_;
  std::uint64_t samples_ = 0;
};

/// Copies what it is shown, and changes the hands.
class Copier {
 public:
  Copier(recording::OutputFile& file, const std::string& tracker, const Eigen::Isometry3d& X_WC,
         const std::string& library)
      : file_(file), tracker_(tracker), X_WC_(X_WC), writer_({"", library}, {}) {}

  mcap::Visitor Visitor() {
    mcap::Visitor visitor;
    visitor.schema = [this](const mcap::Schema& schema) { Copy(schema); };
    visitor.channel = [this](const mcap::Channel& channel) { Copy(channel); };
    visitor.message = [this](const mcap::Message& message) { Copy(message); };
    visitor.attachment = [this](const mcap::Attachment& attachment) {
      writer_.Add(attachment);
      WriteDown();
    };
    visitor.metadata = [this](const mcap::Metadata& metadata) { writer_.Add(metadata); };
    visitor.chunk = [this](const mcap::Chunk& chunk) {
      writer_.SetCompress(chunk.compression == mcap::kZstd);
    };
    return visitor;
  }

  Result<RecalibrateReport> Finish() {
    writer_.Finish();
    WriteDown();
    if (!written_) return written_.error();
    if (const auto synced = file_.Sync(); !synced) return synced.error();
    return report_;
  }

 private:
  void Copy(const mcap::Schema& schema) {
    if (schema.name == kHandSchema) hand_schemas_.insert(schema.id);
    writer_.CopySchema(schema);
  }

  void Copy(const mcap::Channel& channel) {
    if (hand_schemas_.contains(channel.schema_id)) hand_channels_.insert(channel.id);
    writer_.CopyChannel(channel);
  }

  void Copy(mcap::Message message) {
    ++report_.messages;
    std::string changed;
    v1::HandSamples hands;
    if (hand_channels_.contains(message.channel_id) &&
        hands.ParseFromArray(message.data.data(), static_cast<int>(message.data.size()))) {
      for (v1::HandSample& sample : *hands.mutable_samples()) Change(sample);
      changed = hands.SerializeAsString();
      message.data = changed;
    }
    writer_.Add(message);
    WriteDown();
  }

  void Change(v1::HandSample& sample) {
    if (!IsChanged(sample, tracker_)) {
      ++report_.untouched;
      return;
    }
    ++report_.samples;
    sample = wire::ToProto(camera_pose::Recalibrated(wire::FromProto(sample), X_WC_));
  }

  void WriteDown() {
    const std::string bytes = writer_.Take();
    if (written_ && !bytes.empty()) written_ = file_.Write(bytes);
  }

  recording::OutputFile& file_;
  const std::string tracker_;
  const Eigen::Isometry3d X_WC_;
  mcap::Writer writer_;
  std::set<std::uint16_t> hand_schemas_, hand_channels_;
  RecalibrateReport report_;
  Result<void> written_;
};

}  // namespace

Result<RecalibrateReport> Recalibrate(const std::string& input, const std::string& output,
                                      const std::string& tracker, const Eigen::Isometry3d& X_WC,
                                      const std::string& library, bool replace) {
  const auto in = recording::MappedFile::Open(input);
  if (!in) return in.error();
  std::error_code error;
  if (std::filesystem::equivalent(input, output, error))
    return UsageError("the new recording may not replace " + input + "; name another with --out");
  Counter counter(tracker);
  const mcap::WalkEnd found = mcap::Walk(in->bytes(), counter.Visitor(), mcap::WalkMode::kStrict);
  if (!found.complete)
    return InvalidData(input + ": " + found.problem + "; repair it first: footing-log repair " +
                       input + " --out whole.mcap");
  if (counter.samples() == 0)
    return InvalidData(input + " has no hands of the tracker \"" + tracker +
                       "\" with what it saw in its own frame");
  auto out = recording::OutputFile::Create(output, replace);
  if (!out) return out.error();
  Copier copier(*out, tracker, X_WC, library);
  mcap::Walk(in->bytes(), copier.Visitor(), mcap::WalkMode::kStrict);
  return copier.Finish();
}

}  // namespace footing::log_client
