#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <boost/asio/io_context.hpp>

#include "common/base/osc.h"
#include "common/base/result.h"
#include "common/net/address.h"

namespace footing::http_server {
class Server;
}

namespace footing::skeleton {

/// Options of the server of the page with the pose model.
struct WebOptions {
  transport::Address listen;      ///< tcp, of this host only: browsers give it their webcam.
  std::filesystem::path package;  ///< The folder of npm's `@mediapipe/pose`.
  std::function<void(osc::Bytes packet)> on_packet;            ///< OSC packet of a page.
  std::function<void(const std::string& line)> on_state = {};  ///< State that a page reports.
};

/// Counts reported by the pages.
struct WebCounts {
  std::uint64_t pages = 0;    ///< Pages that connected.
  std::uint64_t frames = 0;   ///< Frames through the pose model, of the page that reported last,
  std::uint64_t found = 0;    ///< Those frames that show a person.
  std::uint64_t packets = 0;  ///< Skeletons, of all.
  std::uint64_t refused = 0;  ///< Requests and messages that are none.
};

/// Serves a page that runs a pose model on a webcam, the model's files, and the WebSocket
/// /skeleton, on which the page sends skeletons (docs/skeleton.md). Pages of other origins are
/// refused. Everything runs on the io_context's one thread.
class WebServer {
 public:
  /// Failure when it cannot listen, or the address is not of this host.
  static Result<std::unique_ptr<WebServer>> Open(boost::asio::io_context& io, WebOptions options);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  const WebCounts& counts() const;
  /// Address as bound.
  const transport::Address& address() const;

  struct Desk;

 private:
  WebServer(std::shared_ptr<Desk> desk, std::unique_ptr<http_server::Server> server);

  std::shared_ptr<Desk> desk_;
  std::unique_ptr<http_server::Server> server_;
};

/// A file of the page, which is part of the program.
struct PageFile {
  std::string_view name;
  std::string_view type;  ///< Media type for HTTP.
  std::string_view text;
};

/// "" is index.html; nullptr where there is no such file.
const PageFile* FindPageFile(std::string_view name);

/// Where scripts/fetch-pose-model puts npm's `@mediapipe/pose`:
/// $XDG_DATA_HOME/footing/mediapipe-pose, by default below ~/.local/share.
std::filesystem::path DefaultPosePackage();

/// The file of that name in the package; nothing where the name is none of a file directly in it.
std::optional<std::filesystem::path> ModelFile(const std::filesystem::path& package,
                                               std::string_view name);

/// True when the Host header of a browser's request, "NAME:PORT", names this host. A browser that
/// was led here by a foreign name (DNS rebinding) sends that name.
bool IsOwnHost(std::string_view host);

}  // namespace footing::skeleton
