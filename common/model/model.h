#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace footing::model {

using Digest = std::array<std::uint8_t, 32>;

/// SHA-256 of the bytes: distinguishes a damaged file from a whole one,
/// and one data file from another.
Digest Sha256(std::string_view bytes);

/// In lower-case hexadecimal, as sha256sum prints it.
std::string Hex(const Digest& digest);

/// Models that footing-train makes and the pose engine runs: named float32 tensors with their
/// provenance, one *.fmodel file each (docs/models.md).
constexpr std::size_t kMostFileBytes = 4u << 20;
constexpr std::uint32_t kVersion = 1;  ///< Version of the container; a reader refuses any other.

/// Row by row, last index fastest.
struct Tensor {
  std::string name;
  std::vector<std::uint32_t> shape;
  std::vector<float> values;  ///< As many as the product of `shape`.
  /// Meaning of the last index, such as degrees of freedom; none where the name says it all.
  std::vector<std::string> labels = {};
};

/// A file that a model was trained on.
struct DataFile {
  std::string name;  ///< Without its folder.
  Digest sha256{};
};

/// Where a model comes from: enough to train it again.
struct Provenance {
  std::string program_version;
  std::string command;  ///< The whole command line.
  std::uint64_t seed = 0;
  std::vector<DataFile> data;
  std::vector<std::string> subjects;  ///< Everyone whose motion was used, validation included.
};

/// A trained model: its tensors and where they come from.
struct Model {
  std::string kind;  ///< "cascade", "mlp", "com", "basis", ...
  Provenance provenance;
  std::vector<Tensor> tensors;
};

/// Every tensor has a name of its own, a shape that its number of values fits, and finite values.
/// `origin` names the file.
Result<void> Check(const Model& model, const std::string& origin);

/// Refuses a model of another kind, by name.
Result<void> CheckKind(const Model& model, const std::string& kind, const std::string& origin);

/// A subject as they are written everywhere: a number without leading zeros, else as it is, so that
/// "013" and "13" are one person.
std::string SubjectName(const std::string& subject);

/// Whose motion a file is, by its name without folder and ending: what comes before the first '_',
/// "13" of 013_29; in the names of the corpus HDM05, what comes before the second, "HDM_bd" of
/// HDM_bd_squat1Reps_001_120.
std::string SubjectOfFile(const std::string& stem);

/// Refuses to evaluate a model on a person it was trained with: no score would be cross-subject.
Result<void> CheckNotTrainedOn(const Model& model, const std::string& subject,
                               const std::string& origin);

/// The tensor of this name and exactly this shape.
Result<const Tensor*> Find(const Model& model, const std::string& name,
                           const std::vector<std::uint32_t>& shape, const std::string& origin);

/// The tensor of this name, of any shape; null when there is none.
const Tensor* FindAny(const Model& model, const std::string& name);

}  // namespace footing::model
