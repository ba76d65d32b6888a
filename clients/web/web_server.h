#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "clients/web/passes.h"
#include "common/base/result.h"
#include "common/net/address.h"

namespace footing::web {

/// Options of the server of the pages.
struct WebOptions {
  std::vector<transport::Address> listen;     ///< tcp: of this host, tls: of any.
  std::vector<transport::Address> servers;    ///< footingd's and footing-sim's, in any order.
  std::optional<transport::Address> devices;  ///< footingd's device socket, unix:, for phones.
  std::optional<transport::Address> survey;   ///< Where footing-study asks.
  std::uint16_t skeleton_port = 7110;         ///< UDP, of this host: takes the joints from webcams.
  std::filesystem::path pose_package;   ///< The folder of npm's `@mediapipe/pose`, for webcams.
  std::string token;                    ///< Gives a page the role control; empty: no page has it.
  std::vector<std::string> host_names;  ///< By which browsers may call this host; the first: do.
  std::string identity_file;            ///< For tls:; empty: tls::DefaultIdentityFile().
  bool foxglove = false;                ///< Foxglove's protocol for programs of this host.
  std::vector<std::string> origins;     ///< Pages of others that may use it, as https://HOST.
};

struct WebCounts {
  std::uint64_t connections = 0;  ///< WebSockets that were opened.
  std::uint64_t refused = 0;      ///< Requests that were refused.
  std::uint64_t codes_used = 0;   ///< Browsers that entered by a code.
};

/// Serves the pages and carries messages between a browser's WebSockets and the servers: one
/// binary message is one Envelope (docs/web.md). A page views; it has the role control only with
/// the token. Beyond this host it needs a pass. Foxglove's protocol is served to this host alone.
/// Everything runs on the io_context's one thread.
class WebServer {
 public:
  /// Failure when it cannot listen; usage error for an address of another kind.
  static Result<std::unique_ptr<WebServer>> Open(boost::asio::io_context& io, WebOptions options);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// The address of a page, such as "/phone", for a browser, with a code for one use where the page
  /// needs it.
  std::string Invite(std::string_view page);
  const WebCounts& counts() const;
  /// As bound.
  std::vector<transport::Address> addresses() const;
  /// Fingerprint of the certificate; empty without tls:.
  std::string fingerprint() const;

  struct Desk;

 private:
  explicit WebServer(std::shared_ptr<Desk> desk);

  std::shared_ptr<Desk> desk_;
};

/// Where scripts/fetch-pose-model puts npm's `@mediapipe/pose`:
/// $XDG_DATA_HOME/footing/mediapipe-pose, by default below ~/.local/share.
std::filesystem::path DefaultPosePackage();

/// A file of the pages, which is part of the program.
struct PageFile {
  std::string_view name;
  std::string_view type;  ///< Media type for HTTP.
  std::string_view etag;  ///< With its quotes.
  std::string_view gzip;  ///< The compressed content.
};

/// All files of the pages, sorted by name.
const std::vector<PageFile>& PageFiles();

}  // namespace footing::web
