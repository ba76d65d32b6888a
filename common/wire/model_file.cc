#include "common/wire/model_file.h"

#include <algorithm>

#include "common/wire/scalar.h"
#include "footing/v1/model.pb.h"

namespace footing::wire {
namespace {

// Field 15, length-delimited, 32 bytes: 15 << 3 | 2, 32.
constexpr std::string_view kDigestHead = "\x7a\x20";
constexpr std::size_t kTailBytes = kDigestHead.size() + sizeof(model::Digest);

std::string Bytes(const model::Digest& digest) { return {digest.begin(), digest.end()}; }

void ToProto(const model::Provenance& provenance, v1::Provenance* out) {
  out->set_program_version(Utf8(provenance.program_version));
  out->set_command(Utf8(provenance.command));
  out->set_seed(provenance.seed);
  for (const model::DataFile& file : provenance.data) {
    v1::TrainingData* data = out->add_data();
    data->set_name(Utf8(file.name));
    data->set_sha256(Bytes(file.sha256));
  }
  for (const std::string& subject : provenance.subjects) out->add_subjects(Utf8(subject));
}

Result<model::Provenance> FromProto(const v1::Provenance& in, const std::string& origin) {
  model::Provenance provenance{.program_version = in.program_version(),
                               .command = in.command(),
                               .seed = in.seed(),
                               .data = {},
                               .subjects = {in.subjects().begin(), in.subjects().end()}};
  for (const v1::TrainingData& data : in.data()) {
    model::DataFile file{.name = data.name(), .sha256 = {}};
    if (data.sha256().size() != file.sha256.size()) {
      return InvalidData(origin + ": the checksum of training data " + data.name() + " has " +
                         std::to_string(data.sha256().size()) + " bytes, not 32");
    }
    std::copy(data.sha256().begin(), data.sha256().end(), file.sha256.begin());
    provenance.data.push_back(std::move(file));
  }
  return provenance;
}

/// Nothing when the checksum at the end fits the bytes before it.
Result<void> CheckDigest(std::string_view bytes, const std::string& origin) {
  const bool has_tail = bytes.size() > kTailBytes &&
                        bytes.substr(bytes.size() - kTailBytes, kDigestHead.size()) == kDigestHead;
  if (!has_tail) {
    return InvalidData(origin + ": not a model file, or cut short: it does not end in a checksum");
  }
  const std::string_view content = bytes.substr(0, bytes.size() - kTailBytes);
  if (Bytes(model::Sha256(content)) != bytes.substr(bytes.size() - sizeof(model::Digest))) {
    return InvalidData(origin + ": the file is damaged: its checksum does not fit its content");
  }
  return {};
}

}  // namespace

Result<std::string> ToModelFile(const model::Model& model) {
  if (auto good = model::Check(model, "new model"); !good) return good.error();
  v1::Model out;
  out.set_kind(Utf8(model.kind));
  out.set_version(model::kVersion);
  ToProto(model.provenance, out.mutable_provenance());
  for (const model::Tensor& tensor : model.tensors) {
    v1::Tensor* written = out.add_tensors();
    written->set_name(Utf8(tensor.name));
    written->mutable_shape()->Add(tensor.shape.begin(), tensor.shape.end());
    written->mutable_values()->Add(tensor.values.begin(), tensor.values.end());
    for (const std::string& label : tensor.labels) written->add_labels(Utf8(label));
  }
  std::string bytes = out.SerializeAsString();
  const std::string digest = Bytes(model::Sha256(bytes));
  bytes.append(kDigestHead).append(digest);
  if (bytes.size() > model::kMostFileBytes) {
    return Failure("the model has " + std::to_string(bytes.size()) + " bytes, allowed are " +
                   std::to_string(model::kMostFileBytes) + "; train a smaller one");
  }
  return bytes;
}

Result<model::Model> FromModelFile(std::string_view bytes, const std::string& origin) {
  if (bytes.size() > model::kMostFileBytes) {
    return InvalidData(origin + ": " + std::to_string(bytes.size()) +
                       " bytes, a model has at most " + std::to_string(model::kMostFileBytes));
  }
  if (auto good = CheckDigest(bytes, origin); !good) return good.error();
  v1::Model in;
  if (!in.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return InvalidData(origin + ": not a footing.v1.Model message");
  }
  if (in.version() != model::kVersion) {
    return InvalidData(origin + ": model version " + std::to_string(in.version()) +
                       ", this program reads version " + std::to_string(model::kVersion) +
                       "; train it again with this footing-train");
  }
  const Result<model::Provenance> provenance = FromProto(in.provenance(), origin);
  if (!provenance) return provenance.error();
  model::Model model{.kind = in.kind(), .provenance = *provenance, .tensors = {}};
  for (const v1::Tensor& tensor : in.tensors()) {
    model.tensors.push_back({.name = tensor.name(),
                             .shape = {tensor.shape().begin(), tensor.shape().end()},
                             .values = {tensor.values().begin(), tensor.values().end()},
                             .labels = {tensor.labels().begin(), tensor.labels().end()}});
  }
  if (auto good = model::Check(model, origin); !good) return good.error();
  return model;
}

}  // namespace footing::wire
