#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/model/model.h"

namespace footing::wire {

/// The bytes of a *.fmodel file: a footing.v1.Model whose last field is the SHA-256 of all bytes
/// before it. A model that model::Check refuses, or of more than 4 MB, is an error.
Result<std::string> ToModelFile(const model::Model& model);

/// Checks size, checksum, version and content, in that order; `origin` names the file in errors.
/// What comes back has passed model::Check.
Result<model::Model> FromModelFile(std::string_view bytes, const std::string& origin);

}  // namespace footing::wire
