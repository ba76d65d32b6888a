#include "common/model/model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <openssl/evp.h>

namespace footing::model {

Digest Sha256(std::string_view bytes) {
  Digest digest;
  FOOTING_CHECK(
      EVP_Digest(bytes.data(), bytes.size(), digest.data(), nullptr, EVP_sha256(), nullptr) == 1);
  return digest;
}

std::string Hex(const Digest& digest) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : digest) {
    text.push_back(kDigits[byte >> 4]);
    text.push_back(kDigits[byte & 15]);
  }
  return text;
}

namespace {

constexpr std::uint64_t kMostValues = kMostFileBytes / sizeof(float);

std::string ShapeText(const std::vector<std::uint32_t>& shape) {
  std::string text = "[";
  for (const std::uint32_t size : shape) {
    if (text.size() > 1) text += " x ";
    text += std::to_string(size);
  }
  return text + "]";
}

/// 0 when a size is 0 or there are more values than a file can hold.
std::uint64_t ValuesOf(const std::vector<std::uint32_t>& shape) {
  std::uint64_t values = 1;
  for (const std::uint32_t size : shape) {
    values *= size;
    if (values > kMostValues) return 0;
  }
  return values;
}

}  // namespace

Result<void> Check(const Model& model, const std::string& origin) {
  if (model.kind.empty()) return InvalidData(origin + ": the model has no kind");
  if (model.tensors.empty()) return InvalidData(origin + ": the model has no tensors");
  for (const Tensor& tensor : model.tensors) {
    const std::string where = origin + ": tensor " + tensor.name + ": ";
    if (tensor.name.empty()) return InvalidData(origin + ": a tensor has no name");
    if (FindAny(model, tensor.name) != &tensor) return InvalidData(where + "is there twice");
    if (tensor.shape.empty() || tensor.values.empty() ||
        tensor.values.size() != ValuesOf(tensor.shape)) {
      return InvalidData(where + std::to_string(tensor.values.size()) +
                         " values do not fit shape " + ShapeText(tensor.shape));
    }
    if (!tensor.labels.empty() && tensor.labels.size() != tensor.shape.back()) {
      return InvalidData(where + std::to_string(tensor.labels.size()) +
                         " labels do not fit shape " + ShapeText(tensor.shape));
    }
    if (!std::all_of(tensor.values.begin(), tensor.values.end(),
                     [](float value) { return std::isfinite(value); })) {
      return InvalidData(where + "holds a value that is not finite");
    }
  }
  return {};
}

Result<void> CheckKind(const Model& model, const std::string& kind, const std::string& origin) {
  if (model.kind == kind) return {};
  return InvalidData(origin + ": a model of kind " + model.kind + " where kind " + kind +
                     " belongs; train it with footing-train " + kind);
}

std::string SubjectName(const std::string& subject) {
  const bool number =
      !subject.empty() && subject.find_first_not_of("0123456789") == std::string::npos;
  const std::size_t first = subject.find_first_not_of('0');
  return number && first != std::string::npos ? subject.substr(first) : subject;
}

std::string SubjectOfFile(const std::string& stem) {
  const std::string corpus = "HDM_";
  const std::size_t from = stem.rfind(corpus, 0) == 0 ? corpus.size() : 0;
  return SubjectName(stem.substr(0, stem.find('_', from)));
}

Result<void> CheckNotTrainedOn(const Model& model, const std::string& subject,
                               const std::string& origin) {
  const auto& subjects = model.provenance.subjects;
  const bool trained = std::any_of(subjects.begin(), subjects.end(), [&](const std::string& other) {
    return SubjectName(other) == SubjectName(subject);
  });
  if (!trained) return {};
  return InvalidData(origin + ": was trained on subject " + subject +
                     ", so it cannot be evaluated on them; train one with --exclude " + subject);
}

const Tensor* FindAny(const Model& model, const std::string& name) {
  const auto found = std::find_if(model.tensors.begin(), model.tensors.end(),
                                  [&](const Tensor& tensor) { return tensor.name == name; });
  return found == model.tensors.end() ? nullptr : &*found;
}

Result<const Tensor*> Find(const Model& model, const std::string& name,
                           const std::vector<std::uint32_t>& shape, const std::string& origin) {
  const Tensor* tensor = FindAny(model, name);
  if (tensor == nullptr) return InvalidData(origin + ": tensor " + name + " is missing");
  if (tensor->shape != shape) {
    return InvalidData(origin + ": tensor " + name + " has shape " + ShapeText(tensor->shape) +
                       " where " + ShapeText(shape) + " belongs");
  }
  return tensor;
}

}  // namespace footing::model
