#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace footing::skeleton {

/// Where scripts/fetch-pose-model puts npm's @mediapipe/pose:
/// $XDG_DATA_HOME/footing/mediapipe-pose, by default below ~/.local/share.
std::filesystem::path DefaultPosePackage();

/// The file of that name in the package; nothing where the name is none of a file directly in it.
std::optional<std::filesystem::path> ModelFile(const std::filesystem::path& package,
                                               std::string_view name);

/// What a browser gives as the host that it asks, "NAME:PORT", is this one. One that was led here
/// by a name of somebody else (DNS rebinding) gives that.
bool IsOwnHost(std::string_view host);

}  // namespace footing::skeleton
