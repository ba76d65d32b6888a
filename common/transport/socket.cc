#include "common/transport/socket.h"

#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <cctype>
#include <memory>
#include <utility>

#include "common/clock/clock.h"
#include "common/transport/run_folder.h"

namespace footing::transport {
namespace {

namespace asio = boost::asio;

asio::ip::address NumericHost(const Address& address, boost::system::error_code& error) {
  return asio::ip::make_address(address.host == "localhost" ? "127.0.0.1" : address.host, error);
}

}  // namespace

Result<Endpoint> EndpointOf(const Address& address) {
  if (address.kind == Address::Kind::kUnix) {
    return Endpoint(asio::local::stream_protocol::endpoint(address.path));
  }
  if (address.kind == Address::Kind::kPassed) {
    return UsageError(address.Text() +
                      " is for listening; a client dials unix:PATH or tcp:HOST:PORT");
  }
  boost::system::error_code error;
  const asio::ip::address host = NumericHost(address, error);
  if (error) {
    return UsageError(address.Text() + ": \"" + address.host +
                      "\" is not a numeric address; write for example tcp:127.0.0.1:" +
                      std::to_string(address.port));
  }
  return Endpoint(asio::ip::tcp::endpoint(host, address.port));
}

bool StaysOnThisHost(const Address& address) {
  if (address.kind != Address::Kind::kTcp) return true;
  boost::system::error_code error;
  const asio::ip::address host = NumericHost(address, error);
  return !error && host.is_loopback();
}

void Dial(asio::io_context& io, const Address& address, std::function<void(Result<Socket>)> done) {
  Result<Endpoint> endpoint = EndpointOf(address);
  if (const auto checked = CheckFolderOf(address); !checked) endpoint = checked.error();
  if (!endpoint) {
    asio::post(io, [done = std::move(done), error = endpoint.error()] { done(error); });
    return;
  }
  auto socket = std::make_shared<Socket>(io);
  clock::Act();
  socket->async_connect(
      *endpoint, [socket, address, done = std::move(done)](const boost::system::error_code& error) {
        if (error) {
          done(Failure(address.Text() + ": " + MessageOf(error)));
          return;
        }
        done(std::move(*socket));
      });
}

void Prepare(Socket& socket) {
  constexpr int kSendBufferBytes = 128 << 10;
  boost::system::error_code ignored;  // Settings that only make it better.
  socket.non_blocking(true, ignored);
  socket.set_option(asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
  socket.set_option(asio::ip::tcp::no_delay(true), ignored);
}

std::string MessageOf(const boost::system::error_code& error) {
  if (error == boost::system::errc::no_such_file_or_directory) return "no such file";
  std::string words = error.message();
  if (!words.empty()) words[0] = static_cast<char>(std::tolower(words[0]));
  return words;
}

}  // namespace footing::transport
