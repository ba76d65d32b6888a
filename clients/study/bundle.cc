#include "clients/study/bundle.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <random>
#include <utility>

#include "clients/study/commands.h"
#include "clients/study/session/journal.h"
#include "clients/study/study_tables.h"
#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/recording/bids_tables.h"
#include "common/recording/recorded_session.h"
#include "common/recording/recording_writer.h"
#include "common/runtime/files.h"

namespace footing::study::bundle {
namespace {

using nlohmann::ordered_json;
using records::Records;
using records::Trial;

constexpr const char* kReadme =
    "Motion, events, ratings and results of a study of user interfaces, written by footing-study.\n"
    "\n"
    "A participant controls a simulated character along tracks through several interfaces. Each\n"
    "attempt at a trial is a run of the task that names its interface and kind. The tracking "
    "system\n"
    "sim is the simulated character (x forward along the start of the track, y left, z up, right-\n"
    "handed; gaits: 1 step, 2 walk, 3 run, 4 jump); every other one is a device, in its own frame\n"
    "(x left, y front, z down), named by where it was worn. The channel latency has the time of "
    "each\n"
    "sample; several systems of a run share it, and so do the events.\n"
    "\n"
    "sourcedata/trials.tsv has one row for each attempt, sourcedata/config what the simulation "
    "ran\n"
    "with: version, settings, the interface's mapping table with its values, hashes of the gains,\n"
    "and the features that footingd computed (best, or as the paper prints them).\n"
    "phenotype/survey.tsv has the ratings. Numbers stand for participants, instants count from "
    "the\n"
    "start of 1900, and free text is left out unless the study's owners decided otherwise.\n";

class BundleWriter {
 public:
  BundleWriter(const ParticipantKey& key, const BundleOptions& options)
      : key_(key), options_(options) {}

  Result<BundleReport> Run(const std::vector<Records>& people) {
    for (const Records& person : people) {
      if (const auto done = WriteParticipant(person); !done) return done.error();
    }
    const auto survey = SurveyTable(people, key_, options_.with_text);
    const auto participants = ParticipantsTable(people, key_);
    const auto trials = TrialsTable(people, key_, file_of_);
    const bids::File description =
        bids::DescriptionFile(options_.study_name, "footing-study", options_.version);
    for (const auto& [path, text] :
         {std::pair<std::string, std::string>(description.name, description.text),
          {"README", kReadme},
          {"participants.tsv", participants.tsv},
          {"participants.json", Json(participants.codebook)},
          {"phenotype/survey.tsv", survey.tsv},
          {"phenotype/survey.json", Json(survey.codebook)},
          {"sourcedata/trials.tsv", trials.tsv},
          {"sourcedata/trials.json", Json(trials.codebook)}}) {
      if (const auto done = Write(path, text); !done) return done.error();
    }
    report_.participants = people.size();
    return report_;
  }

 private:
  static std::string Json(const ordered_json& json) { return json.dump(2) + "\n"; }

  Result<void> Write(const std::string& path, const std::string& text) {
    const std::filesystem::path whole = std::filesystem::path(options_.out) / path;
    std::error_code error;
    std::filesystem::create_directories(whole.parent_path(), error);
    if (error) {
      return Failure("cannot create " + whole.parent_path().string() + ": " + error.message());
    }
    auto file = recording::OutputFile::Create(whole.string(), /*replace=*/false);
    if (!file) return file.error();
    return file->Write(text);
  }

  Result<void> WriteParticipant(const Records& person) {
    const std::string subject = key_.SubjectOf(person.participant);
    std::vector<std::vector<std::string>> scans = {{"filename", "acq_time"}};
    for (const Trial& trial : person.trials) {
      if (trial.outcome == records::kInterrupted) continue;
      const auto written = WriteTrial(subject, trial);
      if (!written) return written.error();
      const double since_first_s =
          NanosecondsToSeconds(trial.started_wall_ns - person.trials.front().started_wall_ns);
      for (const std::string& file : *written) {
        scans.push_back({"motion/" + file, bids::ShiftedTime(since_first_s)});
      }
    }
    if (scans.size() == 1) return {};
    return Write(subject + "/" + subject + "_scans.tsv", bids::Tsv(scans));
  }

  /// The names of its motion files; none when there is no recording.
  Result<std::vector<std::string>> WriteTrial(const std::string& subject, const Trial& trial) {
    const std::string path = journal::ParticipantFolder(options_.study_folder, trial.participant) +
                             "/" + trial.recording;
    const auto session = recording::RecordedSession::Open(path);
    if (!session) return Skip(subject, trial, session.error());
    const auto tables = ReadTrial(*session, trial);
    if (!tables) return Skip(subject, trial, tables.error());
    const std::string task = bids::LabelOf(trial.phase);
    const std::string about = trial.interface + ", track " + trial.track +
                              (trial.task.empty() ? "" : ", task " + trial.task);
    const std::string run = "_run-" + std::to_string(trial.attempt);
    const std::string stem = subject + "_task-" + task;
    const std::string folder = subject + "/motion/";
    std::vector<std::string> files;
    for (const bids::MotionTable& table : tables->tables) {
      const auto written = bids::MotionFiles(table, stem, run, task, about);
      files.push_back(written.front().name);
      for (const bids::File& file : written) {
        if (const auto done = Write(folder + file.name, file.text); !done) return done.error();
      }
    }
    if (const ordered_json config = AnonymousConfig(tables->config, tables->sensor_config);
        !config.is_null()) {
      const auto done = Write("sourcedata/config/" + stem + run + "_config.json", Json(config));
      if (!done) return done.error();
    }
    file_of_[&trial] = stem + "_tracksys-*" + run + "_motion.tsv";
    ++report_.trials;
    for (const bids::File& file : bids::EventFiles(tables->events, stem + run)) {
      if (const auto done = Write(folder + file.name, file.text); !done) return done.error();
    }
    return files;
  }

  std::vector<std::string> Skip(const std::string& subject, const Trial& trial,
                                const Error& error) {
    report_.remarks.push_back(subject + ", " + trial.phase + ", attempt " +
                              std::to_string(trial.attempt) + ": " + error.message);
    return {};
  }

  const ParticipantKey& key_;
  const BundleOptions& options_;
  std::map<const Trial*, std::string> file_of_;
  BundleReport report_;
};

}  // namespace

Result<BundleReport> WriteBundle(const std::vector<Records>& people, const ParticipantKey& key,
                                 const BundleOptions& options) {
  if (journal::Exists(options.out)) {
    return UsageError(options.out + " exists and is never overwritten; name another folder");
  }
  if (const auto done = journal::MakeFolder(options.out); !done) return done.error();
  return BundleWriter(key, options).Run(people);
}

}  // namespace footing::study::bundle

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
