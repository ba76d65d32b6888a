#pragma once

#include <cstdint>
#include <string>

#include <sys/types.h>

#include "common/base/result.h"

namespace footing::transport {

/// Where a listener listens and a client dials: "unix:PATH", "tcp:HOST:PORT", or "tls:HOST:PORT"
/// for TLS 1.3 over TCP. A listener may also take the socket that the service manager passed under
/// a name: "fd:NAME"; if that is one of TCP, it speaks TLS.
struct Address {
  enum class Kind { kUnix, kTcp, kTls, kPassed };
  Kind kind = Kind::kUnix;
  std::string path;  ///< Unix socket; of a passed one its name.
  std::string host;  ///< TCP and TLS: a numeric address or "localhost".
  std::uint16_t port = 0;

  std::string Text() const;
  /// Over TCP, in clear or not: the kernel does not know who is at the other end.
  bool OverTcp() const { return kind == Kind::kTcp || kind == Kind::kTls; }
};

/// Usage error with the right form when the text is none.
Result<Address> ParseAddress(const std::string& text);

/// Where a program listens when nothing is said: unix:$XDG_RUNTIME_DIR/footing/NAME.sock, or
/// unix:/tmp/footing-UID/NAME.sock where there is no runtime directory. NAME is "sensor", "devices"
/// or "simulation". A client (`create` not set) finds the service's /run/footing/NAME.sock where
/// the user has none of that name. Creates the folder with mode 0700 if `create` is set.
Address DefaultAddress(const std::string& name, bool create = false);

/// The address that an option of a client gives, or DefaultAddress(name) where its text is empty.
inline Result<Address> AddressOrDefault(const std::string& text, const std::string& name) {
  return text.empty() ? Result<Address>(DefaultAddress(name)) : ParseAddress(text);
}

// Checks of a server before it listens where others than this host's users reach it.

/// Settings that an administrator gives, by the names that the program has for them.
struct ListenSettings {
  std::string keys = "set token_file or clients_file";
  std::string in_clear = "--set insecure_lan=true with a token_file";
};

/// Checks an address that speaks TLS: usage error when nobody has a key, neither a token nor a
/// certificate.
Result<void> CheckKeys(const Address& address, bool has_keys, const ListenSettings& settings = {});

/// Usage error for tcp: beyond this host, unless `in_clear` permits it.
Result<void> CheckEncrypted(const Address& address, bool in_clear,
                            const ListenSettings& settings = {});

/// The folder of the sockets where there is no runtime directory: /tmp/footing-UID. Anybody may
/// make that first, so it is trusted only if it is the own user's alone.
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

/// Remedy for a person when no server answers, to be put behind `why`: "; " and `otherwise`, such
/// as how to start one. Where this user may not open the service's sockets that would not help:
/// then it is to join their group, or nothing where `why` says so already. Empty without
/// `otherwise`.
std::string RemedyFor(const std::string& why, const std::string& otherwise);

}  // namespace footing::transport
