#include "clients/log/export_bids.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <utility>

#include "clients/log/output_folder.h"
#include "common/recording/recorded_motion.h"
#include "common/recording/tables.h"
#include "common/runtime/data_file.h"
#include "common/recording/output_file.h"
#include "common/recording/recorded_session.h"

namespace footing::log_client {
namespace {

constexpr const char* kReadme =
    "Motion and events of recordings, written by footing-log.\n"
    "\n"
    "Each recording is a task of a subject. The tracking system body is the reconstructed person:\n"
    "a place and an orientation of each joint; sim is a simulated character (gaits: 1 step, 2 "
    "walk,\n"
    "3 run, 4 jump). Hands whose names end in tracked were seen by a tracker. All of these have x\n"
    "forward, y left, z up, right-handed. Every other tracking system is a device, in its own "
    "frame\n"
    "(x left, y front, z down), named by where it was worn. The channel latency has the time of\n"
    "each sample from the start of the recording; all systems of a recording share it, and so do\n"
    "the events.\n";

class DataSet {
 public:
  DataSet(std::string folder, const BidsOptions& options)
      : folder_(std::move(folder)), options_(options) {}

  Result<ExportedBids> Add(const bids::RecordedMotion& motion, const std::string& label,
                           const std::string& task, const std::string& recording) {
    const std::string subject = "sub-" + label;
    const std::string stem = subject + "_task-" + task;
    const std::string motions = folder_ + "/" + subject + "/motion";
    if (const auto made = MakeFolder(motions); !made) return made.error();
    ExportedBids exported;
    exported.events = motion.events.size();
    for (const bids::MotionTable& table : motion.tables) {
      const auto files = bids::MotionFiles(table, stem, "", task, "Recording " + recording);
      for (const bids::File& file : files) {
        if (const auto done = Write(motions, file, options_.replace); !done) return done.error();
      }
      exported.tables.push_back({motions + "/" + files.front().name, table.tracksys,
                                 table.channels.size(),
                                 table.cells.size() / table.channels.size()});
    }
    for (const bids::File& file : bids::EventFiles(motion.events, stem)) {
      if (const auto done = Write(motions, file, options_.replace); !done) return done.error();
    }
    if (const auto done = WriteTop(subject); !done) return done.error();
    return exported;
  }

 private:
  static Result<void> Write(const std::string& folder, const bids::File& file, bool replace) {
    auto out = recording::OutputFile::Create(folder + "/" + file.name, replace);
    if (!out) return out.error();
    return out->Write(file.text);
  }

  /// The files of the whole data set, where they are missing, and the subject in its list.
  Result<void> WriteTop(const std::string& subject) const {
    for (const bids::File& file :
         {bids::DescriptionFile("Recordings", "footing-log", options_.version),
          bids::File{"README", kReadme}}) {
      if (std::filesystem::exists(folder_ + "/" + file.name)) continue;
      if (const auto done = Write(folder_, file, false); !done) return done.error();
    }
    const std::string list = folder_ + "/participants.tsv";
    std::string text = "participant_id\n";
    if (std::filesystem::exists(list)) {
      const auto read = config::ReadTextFile(list);
      if (!read) return read.error();
      text = *read;
    }
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      if (line.substr(0, line.find('\t')) == subject) return {};
    }
    if (!text.ends_with('\n')) text += '\n';
    const std::string header = text.substr(0, text.find('\n'));
    const auto more = std::count(header.begin(), header.end(), '\t');  // Columns added by somebody.
    text += subject;
    for (auto i = more; i > 0; --i) text += "\tn/a";
    return Write(folder_, {"participants.tsv", text + "\n"}, true);
  }

  std::string folder_;
  const BidsOptions& options_;
};

}  // namespace

Result<ExportedBids> ExportBids(const std::string& recording, const std::string& folder,
                                const BidsOptions& options) {
  const std::string name = std::filesystem::path(recording).stem().string();
  const std::string subject = options.subject.empty() ? "01" : options.subject;
  const std::string task = options.task.empty() ? bids::LabelOf(name) : options.task;
  for (const auto& [option, label] : {std::pair("--subject", subject), {"--task", task}}) {
    if (label.empty() || bids::LabelOf(label) != label) {
      return UsageError(std::string(option) + " '" + label +
                        "' cannot be a label of a data set: use letters and digits");
    }
  }
  const auto session = recording::RecordedSession::Open(recording);
  if (!session) return session.error();
  const auto motion = bids::ReadMotion(*session, {});
  if (!motion) return motion.error();
  if (motion->tables.empty()) {
    return InvalidData(recording +
                       " has no samples of devices or tracked hands and no frame of footing-sim");
  }
  return DataSet(folder, options).Add(*motion, subject, task, name);
}

}  // namespace footing::log_client
