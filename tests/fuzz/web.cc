#include <string>
#include <string_view>

#include <sys/socket.h>
#include <unistd.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <boost/asio/io_context.hpp>

#include "clients/web/web_server.h"
#include "tests/fuzz/input.h"

/// Bytes of a browser, or of whoever else connects, over a real socket: requests, the handshake of
/// a WebSocket and what follows it. The server answers or closes, and answers the next one.
namespace footing::fuzz {
namespace {

struct Bench {
  boost::asio::io_context io{1};
  std::unique_ptr<web::WebServer> server;
  sockaddr_in address{};

  Bench() {
    web::WebOptions options;
    options.listen = {*transport::ParseAddress("tcp:127.0.0.1:0")};
    options.servers = {*transport::ParseAddress("unix:/nonexistent/footing.sock")};
    options.devices = options.servers.front();
    options.foxglove = true;
    options.token = "0123456789abcdef";
    auto opened = web::WebServer::Open(io, options);
    Expect(opened.ok());
    server = std::move(*opened);
    address.sin_family = AF_INET;
    address.sin_port = htons(server->addresses().front().port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }
};

int Connect(const Bench& bench) {
  const int stream = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const auto* const name = reinterpret_cast<const sockaddr*>(&bench.address);
  Expect(stream >= 0 && connect(stream, name, sizeof(bench.address)) == 0);
  return stream;
}

/// Whatever it answers until it closes, or has nothing more to do at once.
std::string Talk(Bench& bench, std::string_view bytes) {
  const int stream = Connect(bench);
  (void)!send(stream, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  shutdown(stream, SHUT_WR);
  std::string answer;
  for (int turns = 0; turns < 64; ++turns) {
    bench.io.restart();
    while (bench.io.poll_one() > 0) {
    }
    char part[4096];
    const ssize_t got = recv(stream, part, sizeof(part), MSG_DONTWAIT);
    if (got == 0) break;
    if (got > 0) answer.append(part, static_cast<std::size_t>(got));
  }
  close(stream);
  return answer;
}

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  static fuzz::Bench bench;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::string answer = fuzz::Talk(bench, bytes);
  fuzz::Expect(answer.empty() || answer.starts_with("HTTP/1."));
  // A code is never guessed.
  fuzz::Expect(answer.find("Set-Cookie") == std::string::npos);
  const std::string next = fuzz::Talk(bench, "GET / HTTP/1.0\r\nHost: localhost\r\n\r\n");
  fuzz::Expect(next.starts_with("HTTP/1.0 200"));
  return 0;
}
