#include "common/model/model.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

namespace footing::model {
namespace {

constexpr std::size_t kBlockBytes = 64;

// Fractional parts of the cube roots of the first 64 primes (section 4.2.2).
constexpr std::array<std::uint32_t, 64> kRound = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

using State = std::array<std::uint32_t, 8>;

// Fractional parts of the square roots of the first eight primes (section 5.3.3).
constexpr State kStart = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                          0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};

std::uint32_t BigEndian(const char* bytes) {
  std::uint32_t word = 0;
  for (int i = 0; i < 4; ++i) word = word << 8 | static_cast<unsigned char>(bytes[i]);
  return word;
}

std::uint32_t SmallSigma(std::uint32_t x, int a, int b, int shift) {
  return std::rotr(x, a) ^ std::rotr(x, b) ^ (x >> shift);
}

std::uint32_t BigSigma(std::uint32_t x, int a, int b, int c) {
  return std::rotr(x, a) ^ std::rotr(x, b) ^ std::rotr(x, c);
}

void Take(const char* block, State& state) {
  std::array<std::uint32_t, 64> w;
  for (std::size_t t = 0; t < 16; ++t) w[t] = BigEndian(block + 4 * t);
  for (std::size_t t = 16; t < 64; ++t) {
    w[t] =
        SmallSigma(w[t - 2], 17, 19, 10) + w[t - 7] + SmallSigma(w[t - 15], 7, 18, 3) + w[t - 16];
  }
  auto [a, b, c, d, e, f, g, h] = state;
  for (std::size_t t = 0; t < 64; ++t) {
    const std::uint32_t t1 = h + BigSigma(e, 6, 11, 25) + ((e & f) ^ (~e & g)) + kRound[t] + w[t];
    const std::uint32_t t2 = BigSigma(a, 2, 13, 22) + ((a & b) ^ (a & c) ^ (b & c));
    h = g, g = f, f = e, e = d + t1, d = c, c = b, b = a, a = t1 + t2;
  }
  const State sum = {a, b, c, d, e, f, g, h};
  for (std::size_t i = 0; i < state.size(); ++i) state[i] += sum[i];
}

}  // namespace

Digest Sha256(std::string_view bytes) {
  State state = kStart;
  const std::uint64_t bits = std::uint64_t{bytes.size()} * 8;
  for (; bytes.size() >= kBlockBytes; bytes.remove_prefix(kBlockBytes)) Take(bytes.data(), state);

  std::string last(bytes);  // Padding: one bit, zeros, and the length in bits.
  last.push_back('\x80');
  while (last.size() % kBlockBytes != kBlockBytes - 8) last.push_back('\0');
  for (int shift = 56; shift >= 0; shift -= 8) last.push_back(static_cast<char>(bits >> shift));
  for (std::size_t at = 0; at < last.size(); at += kBlockBytes) Take(last.data() + at, state);

  Digest digest;
  for (std::size_t i = 0; i < digest.size(); ++i) {
    digest[i] = static_cast<std::uint8_t>(state[i / 4] >> (24 - 8 * (i % 4)));
  }
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
