#include "clients/log/recalibrate.h"

#include <filesystem>
#include <set>

#include "common/camera/samples.h"
#include "common/recording/walk.h"
#include "common/recording/writer.h"
#include "common/recording/mapped_file.h"
#include "common/recording/output_file.h"
#include "common/wire/wire.h"
#include "footing/v1/sensor.pb.h"

namespace footing::log_client {
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
