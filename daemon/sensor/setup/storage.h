#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "common/base/result.h"

namespace footing::setup {

/// Texts kept by name between two runs. Null functions: nothing is kept.
struct Storage {
  /// None if nothing was saved under this name.
  std::function<std::optional<std::string>(const std::string& name)> load;
  std::function<void(const std::string& name, const std::string& content)> save;
  /// For content that its reader does not understand.
  std::function<void(const std::string& name, const std::string& why)> refuse;
};

/// What `read` makes of the text saved under this name. None if there is none; text that it cannot
/// read is refused and none as well.
template <typename Content>
std::optional<Content> Load(const Storage& storage, const std::string& name,
                            Result<Content> (*read)(const std::string& text)) {
  if (!storage.load) return std::nullopt;
  const std::optional<std::string> text = storage.load(name);
  if (!text) return std::nullopt;
  Result<Content> content = read(*text);
  if (content) return std::move(content).value();
  if (storage.refuse) storage.refuse(name, content.error().message);
  return std::nullopt;
}

}  // namespace footing::setup
