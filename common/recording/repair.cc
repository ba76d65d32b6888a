#include "common/recording/repair.h"

#include <filesystem>
#include <system_error>

#include "common/mcap/writer.h"
#include "common/recording/mapped_file.h"
#include "common/recording/output_file.h"

namespace footing::recording {
namespace {

/// Copies what it is shown into a new file, chunk by chunk.
class Copier {
 public:
  Copier(OutputFile& file, const std::string& library, RepairReport& report)
      : file_(file), writer_({"", library}, {}), report_(report) {}

  mcap::Visitor Visitor() {
    mcap::Visitor visitor;
    visitor.schema = [this](const mcap::Schema& schema) { writer_.CopySchema(schema); };
    visitor.channel = [this](const mcap::Channel& channel) { writer_.CopyChannel(channel); };
    visitor.message = [this](const mcap::Message& message) {
      ++report_.messages;
      writer_.Add(message);
      WriteDown();
    };
    visitor.attachment = [this](const mcap::Attachment& attachment) {
      ++report_.attachments;
      writer_.Add(attachment);
      WriteDown();
    };
    visitor.metadata = [this](const mcap::Metadata& metadata) {
      ++report_.metadata;
      writer_.Add(metadata);
    };
    return visitor;
  }

  Result<void> Finish() {
    writer_.Finish();
    WriteDown();
    if (!written_) return written_;
    return file_.Sync();
  }

 private:
  void WriteDown() {
    const std::string bytes = writer_.Take();
    if (written_ && !bytes.empty()) written_ = file_.Write(bytes);
  }

  OutputFile& file_;
  mcap::Writer writer_;
  RepairReport& report_;
  Result<void> written_;
};

}  // namespace

Result<RepairReport> Repair(const std::string& input, const std::string& output,
                            const std::string& library, bool replace) {
  Result<MappedFile> in = MappedFile::Open(input);
  if (!in) return in.error();
  const std::string_view magic = in->bytes().substr(0, mcap::kMagic.size());
  if (magic.empty() || magic != mcap::kMagic.substr(0, magic.size())) {
    return InvalidData(input + " is not an MCAP file: there is nothing to repair");
  }
  std::error_code error;
  if (std::filesystem::equivalent(input, output, error)) {
    return UsageError("the repaired file may not replace " + input + "; name another with --out");
  }
  Result<OutputFile> out = OutputFile::Create(output, replace);
  if (!out) return out.error();

  RepairReport report;
  report.input_bytes = in->bytes().size();
  Copier copier(*out, library, report);
  report.found = mcap::Walk(in->bytes(), copier.Visitor(), mcap::WalkMode::kSalvage);
  if (const Result<void> finished = copier.Finish(); !finished) return finished.error();
  return report;
}

}  // namespace footing::recording
