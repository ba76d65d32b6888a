#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "clients/log/commands.h"
#include "clients/log/contents.h"
#include "common/cli/cli.h"
#include "common/base/json_text.h"
#include "common/base/number.h"
#include "common/base/units.h"

namespace footing::log_client {
namespace {

using nlohmann::ordered_json;

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
    for (const auto& [key, value] : metadata.values) std::cout << " " << key << "=" << value;
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

}  // namespace footing::log_client
