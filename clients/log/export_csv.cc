#include "clients/log/export_csv.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "clients/log/output_folder.h"
#include "clients/log/tables.h"
#include "common/recording/mapped_file.h"
#include "common/recording/output_file.h"

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
  std::optional<recording::OutputFile> file;
  std::string text;
  ExportedFile exported;
};

class CsvExporter {
 public:
  CsvExporter(std::string_view bytes, const std::string& path) : tables_(bytes, path) {}

  Result<std::vector<ExportedFile>> Run(const std::string& folder, bool replace) {
    if (const Result<void> learned = tables_.Learn(); !learned) return learned.error();
    if (const Result<void> opened = Open(folder, replace); !opened) return opened.error();
    const Result<void> written =
        tables_.Walk([this](std::uint16_t channel, const mcap::Message& record,
                            const google::protobuf::Message& message) {
          return WriteRows(tables_.topics().at(channel), record, message, sheets_[channel]);
        });
    if (!written) return written.error();
    std::vector<ExportedFile> files;
    for (auto& [channel, sheet] : sheets_) {
      if (const Result<void> end = sheet.file->Write(sheet.text); !end) return end.error();
      files.push_back(sheet.exported);
    }
    return files;
  }

 private:
  Result<void> Open(const std::string& folder, bool replace) {
    if (const Result<void> made = MakeFolder(folder); !made) return made.error();
    std::set<std::string> taken;
    for (const auto& [channel, topic] : tables_.topics()) {
      if (!topic.table) continue;
      Sheet& sheet = sheets_[channel];
      std::string name = FileName(topic.topic);
      while (!taken.insert(name).second) name += "_";
      const std::string path = folder + "/" + name + ".csv";
      Result<recording::OutputFile> file = recording::OutputFile::Create(path, replace);
      if (!file) return file.error();
      sheet.file.emplace(std::move(*file));
      sheet.exported = {topic.topic, path, 0};
      const std::string columns = topic.table->Header();
      sheet.text = "log_time_ns,publish_time_ns,sequence" + (columns.empty() ? "" : "," + columns);
      for (const std::string& column : tables_.notes().Columns(topic.table->row_type())) {
        // The message's own column of that name comes first; ours says that it is a note.
        const bool is_own = ("," + columns + ",").find("," + column + ",") != std::string::npos;
        sheet.text += "," + (is_own ? "note_" + column : column);
      }
      sheet.text += "\n";
    }
    return {};
  }

  Result<void> WriteRows(const TopicTable& topic, const mcap::Message& record,
                         const google::protobuf::Message& message, Sheet& sheet) {
    const std::string prefix = std::to_string(record.log_time_ns) + "," +
                               std::to_string(record.publish_time_ns) + "," +
                               std::to_string(record.sequence) + ",";
    const std::size_t before = sheet.text.size();
    const auto end = [&](const google::protobuf::Message* entry) {
      return tables_.notes().Cells(topic.topic, topic.table->row_type(), entry, record.log_time_ns);
    };
    topic.table->AppendRows(message, prefix, end, sheet.text);
    sheet.exported.rows += static_cast<std::uint64_t>(std::count(
        sheet.text.begin() + static_cast<std::ptrdiff_t>(before), sheet.text.end(), '\n'));
    if (sheet.text.size() < kWriteBytes) return {};
    Result<void> written = sheet.file->Write(sheet.text);
    sheet.text.clear();
    return written;
  }

  Tables tables_;
  std::map<std::uint16_t, Sheet> sheets_;
};

}  // namespace

Result<std::vector<ExportedFile>> ExportCsv(const std::string& recording, const std::string& folder,
                                            bool replace) {
  Result<recording::MappedFile> file = recording::OpenRecording(recording);
  if (!file) return file.error();
  return CsvExporter(file->bytes(), recording).Run(folder, replace);
}

}  // namespace footing::log_client
