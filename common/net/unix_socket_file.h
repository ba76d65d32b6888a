#pragma once

#include <sys/types.h>

#include <functional>
#include <string>

#include "common/base/result.h"

/// The file behind a Unix socket: whose it is, and when it may go.
namespace footing::transport {

/// Clears the way for a server at `path` and calls `bind` there, all under a lock on the folder, so
/// that two servers started at once cannot take each other's file. Only a socket that nobody
/// answers on is removed. `address_text` is for the error line.
Result<void> BindWhereNobodyListens(const std::string& path, const std::string& address_text,
                                    const std::function<Result<void>()>& bind);

/// Which file it is, so that at the end only the own one is removed.
struct FileIdentity {
  dev_t device = 0;
  ino_t inode = 0;
};
FileIdentity IdentityOf(const std::string& path);
void RemoveIfStill(const std::string& path, const FileIdentity& identity);

}  // namespace footing::transport
