#include "common/recording/repair.h"

#include <filesystem>
#include <map>
#include <system_error>

#include "common/recording/mcap_writer.h"
#include "common/recording/recording_writer.h"
#include "footing/v1/session.pb.h"

namespace footing::recording {
namespace {

/// Ids of what the damage may hide count from 1, as every writer's here do: those of the gaps from
/// the other end.
constexpr std::uint16_t kLastId = 65'535;

/// Copies what it is shown into a new file, chunk by chunk. Where damage took ticks of a server, it
/// puts a Gap, as the recorder does where ticks never came.
class Copier {
 public:
  Copier(OutputFile& file, const std::string& library, RepairReport& report)
      : file_(file), writer_({"", library}, {}), report_(report) {}

  mcap::Visitor Visitor() {
    mcap::Visitor visitor;
    visitor.schema = [this](const mcap::Schema& schema) { writer_.CopySchema(schema); };
    visitor.channel = [this](const mcap::Channel& channel) {
      servers_of_[channel.id] = channel.topic.substr(0, channel.topic.rfind('/'));
      writer_.CopyChannel(channel);
    };
    visitor.damage = [this] { ++damage_; };
    visitor.chunk = [this](const mcap::Chunk& chunk) {
      writer_.SetCompress(chunk.compression == mcap::kZstd);
    };
    visitor.message = [this](const mcap::Message& message) {
      ++report_.messages;
      NoteMissing(message);
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
      NoteSession(metadata);
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
  struct Server {
    std::uint16_t gaps_channel = 0;
    std::uint64_t damage = 0;  ///< Seen before its last message.
    mcap::Message last;        ///< With the highest number so far.
  };

  /// Writes a Gap when damage lies between this message and its server's last one, and the numbers
  /// of their ticks do not follow each other. Files of others may number otherwise.
  void NoteMissing(const mcap::Message& message) {
    const std::string& name = servers_of_[message.channel_id];
    if (epochs_.count(name) == 0) return;
    const auto [found, fresh] = servers_.try_emplace(name);
    Server& server = found->second;
    if (!fresh && server.damage < damage_ && message.sequence > server.last.sequence + 1) {
      v1::Gap gap;
      gap.set_from_sequence(server.last.sequence + 1);
      gap.set_to_sequence(message.sequence - 1);
      gap.set_reason(v1::Gap::REASON_DAMAGED);
      report_.missing_ticks += gap.to_sequence() - gap.from_sequence() + 1;
      if (server.gaps_channel == 0) server.gaps_channel = AddGapsChannel(name);
      const std::string bytes = gap.SerializeAsString();
      mcap::Message record = server.last;
      record.channel_id = server.gaps_channel;
      record.data = bytes;
      writer_.Add(record);
    }
    server.damage = damage_;
    // A tick that a reconnected recorder fetched from the ring has a lower number than the one
    // before it.
    if (fresh || message.sequence > server.last.sequence) server.last = message;
  }

  /// A server that was started again counts its ticks from 1.
  void NoteSession(const mcap::Metadata& metadata) {
    if (metadata.name != "session") return;
    const auto name = metadata.values.find("server");
    const auto epoch = metadata.values.find("epoch");
    if (name == metadata.values.end() || epoch == metadata.values.end()) return;
    std::string& known = epochs_["/" + name->second];
    if (known != epoch->second) servers_.erase("/" + name->second);
    known = epoch->second;
  }

  std::uint16_t AddGapsChannel(const std::string& server) {
    const v1::Gap& type = v1::Gap::default_instance();
    if (gaps_channels_ == 0) {
      writer_.CopySchema(
          {kLastId, type.GetTypeName(), "protobuf", DescribeWithImports(*type.GetDescriptor())});
    }
    const auto id = static_cast<std::uint16_t>(kLastId - gaps_channels_++);
    writer_.CopyChannel({id, kLastId, server + "/gaps", "protobuf", {}});
    return id;
  }

  void WriteDown() {
    const std::string bytes = writer_.Take();
    if (written_ && !bytes.empty()) written_ = file_.Write(bytes);
  }

  OutputFile& file_;
  mcap::Writer writer_;
  RepairReport& report_;
  Result<void> written_;
  std::uint64_t damage_ = 0;  ///< Places at which something was left out.
  std::uint16_t gaps_channels_ = 0;
  std::map<std::uint16_t, std::string> servers_of_;  ///< "/SERVER", by channel.
  std::map<std::string, Server> servers_;
  std::map<std::string, std::string> epochs_;  ///< By server, of its newest session.
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
