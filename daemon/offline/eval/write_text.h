#pragma once

#include <string>

#include "common/base/result.h"

namespace footing::eval {

/// A file with this text; one of before is overwritten.
Result<void> WriteText(const std::string& path, const std::string& text);

}  // namespace footing::eval
