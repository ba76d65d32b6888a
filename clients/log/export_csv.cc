#include "clients/log/export_csv.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "clients/log/contents.h"
#include "clients/log/csv_table.h"
#include "clients/log/row_notes.h"
#include "common/mcap/walk.h"
#include "common/recording/mapped_file.h"
#include "common/recording/output_file.h"
#include "common/recording/schema.h"

namespace footing::log_client {
namespace {

constexpr std::size_t kWriteBytes = 1u << 20;

/// The topic's name as a file's: what is not a letter, a digit or '-' becomes '_'.
std::string FileName(const std::string& topic) {
  std::string name;
  for (const char c : topic.substr(
           topic.find_first_not_of('/') == std::string::npos ? 0 : topic.find_first_not_of('/'))) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-';
    name += plain ? c : '_';
  }
  return name.empty() ? "topic" : name;
}

/// One topic on its way into a file.
struct Sheet {
  std::string topic;
  std::uint16_t schema_id = 0;
  std::optional<CsvTable> table;
  std::optional<recording::OutputFile> file;
  std::string text;
  ExportedFile exported;
};

class Exporter {
 public:
  Exporter(std::string_view bytes, std::string path) : bytes_(bytes), path_(std::move(path)) {}

  Result<std::vector<ExportedFile>> Run(const std::string& folder, bool replace) {
    const mcap::WalkEnd end = LearnColumns();
    if (!first_failure_) return first_failure_.error();
    if (const std::optional<Error> incomplete = Incomplete(path_, end)) return *incomplete;
    if (const Result<void> opened = Open(folder, replace); !opened) return opened.error();
    WriteRows();
    std::vector<ExportedFile> files;
    for (auto& [channel, sheet] : sheets_) {
      if (!sheet.file) continue;
      Fail(sheet.file->Write(sheet.text));
      files.push_back(sheet.exported);
    }
    if (!first_failure_) return first_failure_.error();
    return files;
  }

 private:
  mcap::WalkEnd LearnColumns() {
    mcap::Visitor visitor;
    visitor.schema = [this](const mcap::Schema& schema) {
      if (const Result<void> added = pool_.Add(schema); !added) {
        Fail(InvalidData(path_ + ": " + added.error().message));
      }
    };
    visitor.channel = [this](const mcap::Channel& channel) {
      Sheet& sheet = sheets_[channel.id];
      sheet.topic = channel.topic;
      sheet.schema_id = channel.schema_id;
    };
    visitor.metadata = [this](const mcap::Metadata& metadata) {
      if (metadata.name == "session") notes_.TakeSession(metadata.values);
    };
    visitor.message = [this](const mcap::Message& message) {
      Sheet& sheet = sheets_[message.channel_id];
      const google::protobuf::Message* parsed = Parse(sheet, message);
      if (parsed == nullptr) return;
      notes_.TakeTime(message.log_time_ns);
      notes_.Take(sheet.topic, message.data);
      if (!sheet.table) sheet.table.emplace(*parsed->GetDescriptor());
      Fail(sheet.table->Learn(*parsed));
    };
    return mcap::Walk(bytes_, visitor, mcap::WalkMode::kStrict);
  }

  Result<void> Open(const std::string& folder, bool replace) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return Failure("cannot make the folder " + folder + ": " + error.message());
    std::set<std::string> taken;
    for (auto& [channel, sheet] : sheets_) {
      if (!sheet.table) continue;
      std::string name = FileName(sheet.topic);
      while (!taken.insert(name).second) name += "_";
      const std::string path = folder + "/" + name + ".csv";
      Result<recording::OutputFile> file = recording::OutputFile::Create(path, replace);
      if (!file) return file.error();
      sheet.file.emplace(std::move(*file));
      sheet.exported = {sheet.topic, path, 0};
      const std::string columns = sheet.table->Header();
      sheet.text = "log_time_ns,publish_time_ns,sequence" + (columns.empty() ? "" : "," + columns);
      for (const std::string& column : notes_.Columns(sheet.table->row_type())) {
        // The message's own column of that name comes first; ours says that it is a note.
        const bool is_own = ("," + columns + ",").find("," + column + ",") != std::string::npos;
        sheet.text += "," + (is_own ? "note_" + column : column);
      }
      sheet.text += "\n";
    }
    return {};
  }

  void WriteRows() {
    mcap::Visitor visitor;
    visitor.message = [this](const mcap::Message& message) {
      if (!first_failure_) return;
      Sheet& sheet = sheets_[message.channel_id];
      const google::protobuf::Message* parsed = Parse(sheet, message);
      if (parsed == nullptr || !sheet.file) return;
      const std::string prefix = std::to_string(message.log_time_ns) + "," +
                                 std::to_string(message.publish_time_ns) + "," +
                                 std::to_string(message.sequence) + ",";
      const std::size_t before = sheet.text.size();
      notes_.Take(sheet.topic, message.data);
      const auto end = [&](const google::protobuf::Message* entry) {
        return notes_.Cells(sheet.topic, sheet.table->row_type(), entry, message.log_time_ns);
      };
      sheet.table->AppendRows(*parsed, prefix, end, sheet.text);
      sheet.exported.rows += static_cast<std::uint64_t>(std::count(
          sheet.text.begin() + static_cast<std::ptrdiff_t>(before), sheet.text.end(), '\n'));
      if (sheet.text.size() < kWriteBytes) return;
      Fail(sheet.file->Write(sheet.text));
      sheet.text.clear();
    };
    mcap::Walk(bytes_, visitor, mcap::WalkMode::kStrict);
  }

  const google::protobuf::Message* Parse(const Sheet& sheet, const mcap::Message& message) {
    const google::protobuf::Message* parsed = pool_.Parse(sheet.schema_id, message.data);
    if (parsed == nullptr) {
      Fail(InvalidData(path_ + ": a message on " + sheet.topic + " does not fit its schema"));
    }
    return parsed;
  }

  /// Keeps the first failure.
  void Fail(Result<void> result) {
    if (!result && first_failure_) first_failure_ = std::move(result);
  }

  std::string_view bytes_;
  std::string path_;
  recording::SchemaPool pool_;
  RowNotes notes_;  ///< Of the first pass, then as the second goes on.
  std::map<std::uint16_t, Sheet> sheets_;
  Result<void> first_failure_;
};

}  // namespace

Result<std::vector<ExportedFile>> ExportCsv(const std::string& recording, const std::string& folder,
                                            bool replace) {
  Result<recording::MappedFile> file = recording::OpenRecording(recording);
  if (!file) return file.error();
  return Exporter(file->bytes(), recording).Run(folder, replace);
}

}  // namespace footing::log_client
