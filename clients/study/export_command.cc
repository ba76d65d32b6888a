#include <memory>
#include <random>
#include <utility>

#include "clients/study/bundle.h"
#include "clients/study/commands.h"
#include "clients/study/session/study_folder.h"
#include "common/cli/cli.h"
#include "common/runtime/data_file.h"

namespace footing::study {
namespace {

struct ExportOptions {
  ProtocolOptions protocol;
  std::string out;
  bool with_text = false;
};

/// The key of the study with a number for each participant: the one of the last export, with new
/// participants added. The order of new numbers follows from nothing.
Result<bundle::ParticipantKey> KeepKey(const std::string& path,
                                       const std::vector<records::Records>& people) {
  bundle::ParticipantKey key;
  if (journal::Exists(path)) {
    const auto text = config::ReadTextFile(path);
    if (!text) return text.error();
    auto before = bundle::ParticipantKey::Parse(*text, path);
    if (!before) return before.error();
    key = std::move(*before);
  }
  std::vector<std::string> codes;
  for (const records::Records& person : people) codes.push_back(person.participant);
  std::random_device device;
  key.Add(std::move(codes), (static_cast<std::uint64_t>(device()) << 32) | device());
  if (const auto done = journal::ReplaceFile(path, key.Text()); !done) return done.error();
  return key;
}

Result<Answer> Export(const ExportOptions& options) {
  const auto loaded = Load(options.protocol.path, options.protocol.folder);
  if (!loaded) return loaded.error();
  auto people = ReadPeople(*loaded);
  if (!people) return people.error();
  std::erase_if(*people, [](const records::Records& person) { return person.withdrawn; });
  const std::string key_path = loaded->folder + "/participant_key.csv";
  const auto key = KeepKey(key_path, *people);
  if (!key) return key.error();
  const auto report = bundle::WriteBundle(
      *people, *key,
      {loaded->protocol.name, loaded->folder, options.out, options.with_text, cli::Version()});
  if (!report) return report.error();
  Answer answer{{{"folder", options.out},
                 {"key", key_path},
                 {"participants", report->participants},
                 {"trials", report->trials},
                 {"remarks", report->remarks}},
                "wrote " + options.out + ": " + std::to_string(report->participants) +
                    (report->participants == 1 ? " participant, " : " participants, ") +
                    std::to_string(report->trials) + " trials; only " + key_path +
                    " relates their numbers to participants"};
  for (const std::string& remark : report->remarks) answer.text += "\nleft out: " + remark;
  return answer;
}

}  // namespace

void AddExportCommand(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* command =
      app.add_subcommand("export", "Write an anonymised data set in the form of BIDS-motion");
  AddProtocolOptions(*command, options->protocol);
  command->add_option("--out", options->out, "Folder of the data set; must not exist")->required();
  command->add_flag("--with-text", options->with_text,
                    "Include the free-text answers: read them first, they may identify a person");
  command->callback([options, &shared] { Finish(Export(*options), shared); });
}

}  // namespace footing::study
