#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/status.hpp>
#include <boost/beast/http/string_body.hpp>

#include "common/base/result.h"
#include "common/net/address.h"
#include "common/net/http_stream.h"
#include "common/net/listener.h"

/// HTTP/1.0 and 1.1, in clear or over TLS.
namespace footing::http_server {

using Request = boost::beast::http::request<boost::beast::http::string_body>;
using Headers = std::vector<std::pair<std::string, std::string>>;

struct Answer {
  boost::beast::http::status status = boost::beast::http::status::ok;
  std::string type;                 ///< Content-Type.
  std::string text = {};            ///< The body.
  std::filesystem::path file = {};  ///< Its content is the body; empty: `text` is.
  Headers headers = {};             ///< Besides those of every answer.
};

/// A place among the connections; it is free when the last copy is gone.
using Place = std::shared_ptr<void>;

struct Options {
  int most_connections = 8;              ///< More are closed at once.
  std::size_t most_header_bytes = 4096;  ///< A request has no more; at most kMostHeaderBytes.
  std::size_t most_body_bytes = 0;       ///< A longer one is refused by its announced length.
  std::chrono::seconds request_within{5};
  std::chrono::seconds answer_within{5};
  std::chrono::seconds file_within{60};  ///< For the content of a file.
  std::chrono::seconds next_within{0};   ///< For another request of the connection; 0: only one.
  Headers headers = {};                  ///< Each answer has them.
  /// The answer to a request; nullptr: what came is not one.
  std::function<Answer(const Request*)> answer;
  /// Takes over the connection of a request, or returns false. Without it nobody does.
  std::function<bool(const Request&, Stream&, const Place&)> upgrade = {};
};

inline constexpr std::size_t kMostHeaderBytes = 8192;

/// Everything runs on the io_context's one thread. At its end no function of the options is called
/// any more.
class Server {
 public:
  static Result<std::unique_ptr<Server>> Open(boost::asio::io_context& io,
                                              const transport::Address& address, Options options,
                                              const transport::ListenSecurity& security = {});
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Address as bound.
  const transport::Address& address() const { return listener_->address(); }

  struct Desk;

 private:
  Server(std::shared_ptr<Desk> desk, std::unique_ptr<transport::Listener> listener);

  std::shared_ptr<Desk> desk_;
  std::unique_ptr<transport::Listener> listener_;
};

}  // namespace footing::http_server
