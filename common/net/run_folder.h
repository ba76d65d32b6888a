#pragma once

#include <sys/types.h>

#include <string>

#include "common/base/result.h"
#include "common/net/address.h"

/// The folder of the sockets where there is no runtime directory: /tmp/footing-UID. Anybody may
/// make that first, so it is trusted only if it is the own user's alone.
namespace footing::transport {

std::string FallbackRunFolder();

/// The folder of the default addresses of this user: $XDG_RUNTIME_DIR/footing, or the fallback.
std::string RunFolder();

/// Makes RunFolder() where the address is in it. A failure shows when the address is bound.
void MakeRunFolderFor(const Address& address);

/// An error when `folder` exists and is not a folder (a symbolic link is not one), belongs to
/// another user, or others may write to it.
Result<void> CheckRunFolder(const std::string& folder, uid_t own_user);

/// CheckRunFolder for an address in the fallback folder; any other address passes.
Result<void> CheckFolderOf(const Address& address);

/// What a person does when no server answers, to be put behind `why`: "; " and `otherwise`, such as
/// how to start one. Where this user may not open the service's sockets that would not help: then
/// it is to join their group, or nothing where `why` says so already. Empty without `otherwise`.
std::string RemedyFor(const std::string& why, const std::string& otherwise);

}  // namespace footing::transport
