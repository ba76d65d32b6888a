#include "common/net/metrics_endpoint.h"

#include <sys/stat.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>

#include "tests/common/net/io_fixture.h"

namespace footing::monitoring {
namespace {

namespace asio = boost::asio;
using Unix = asio::local::stream_protocol;

class MetricsEndpointTest : public transport::IoFixture {
 protected:
  void SetUp() override {
    auto opened = MetricsEndpoint::Open(io_, UnixAddress().Text(), [this] {
      ++pages_;
      return std::string("footing_ticks_total 1\n");
    });
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    endpoint_ = std::move(*opened);
  }

  Unix::socket Connect() {
    Unix::socket socket(io_);
    socket.connect(Unix::endpoint(UnixAddress().path));
    return socket;
  }

  /// All that comes until the other side closes.
  std::string Ask(const std::string& request) {
    Unix::socket socket = Connect();
    asio::write(socket, asio::buffer(request));
    return ReadAll(socket);
  }
  std::string ReadAll(Unix::socket& socket) {
    std::string answer;
    bool over = false;
    asio::async_read(socket, asio::dynamic_buffer(answer),
                     [&](const boost::system::error_code&, std::size_t) { over = true; });
    EXPECT_TRUE(RunUntil([&] { return over; }));
    return answer;
  }

  std::unique_ptr<MetricsEndpoint> endpoint_;
  int pages_ = 0;
};

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(MetricsEndpointTest, AnswersHttp10And11AndEndsTheConnection) {
  for (const std::string version : {"1.0", "1.1"}) {
    const std::string answer = Ask("GET /metrics HTTP/" + version + "\r\nHost: x\r\n\r\n");
    EXPECT_TRUE(answer.starts_with("HTTP/" + version + " 200 OK\r\n")) << answer;
    EXPECT_TRUE(Has(answer, "Content-Type: text/plain; version=0.0.4")) << answer;
    EXPECT_TRUE(Has(answer, "Content-Length: 22\r\n")) << answer;
    EXPECT_TRUE(answer.ends_with("\r\n\r\nfooting_ticks_total 1\n")) << answer;
  }
  EXPECT_EQ(pages_, 2);
}

TEST_F(MetricsEndpointTest, RefusesWhatIsNotAGetOfTheMetrics) {
  EXPECT_TRUE(Ask("GET /secret HTTP/1.0\r\n\r\n").starts_with("HTTP/1.0 404"));
  EXPECT_TRUE(Ask("POST /metrics HTTP/1.0\r\n\r\n").starts_with("HTTP/1.0 405"));
  EXPECT_TRUE(
      Ask("PUT /metrics HTTP/1.1\r\nContent-Length: 99999999\r\n\r\n").starts_with("HTTP/1."));
  EXPECT_TRUE(Has(Ask(std::string(100, 'x') + "\r\n\r\n"), " 400 "));
  EXPECT_TRUE(Has(Ask("GET / HTTP/1.0\r\nX: " + std::string(5000, 'x') + "\r\n\r\n"), " 400 "));
  EXPECT_EQ(pages_, 0);
}

TEST_F(MetricsEndpointTest, ARequestMayComeByteByByte) {
  Unix::socket socket = Connect();
  for (const char c : std::string("GET /metrics HTTP/1.0\r\n\r\n")) {
    asio::write(socket, asio::buffer(&c, 1));
    Settle();
  }
  EXPECT_TRUE(ReadAll(socket).starts_with("HTTP/1.0 200"));
}

TEST_F(MetricsEndpointTest, NoMoreThanEightConnectionsAreHeldOpen) {
  std::vector<Unix::socket> idle;
  for (int i = 0; i < 8; ++i) idle.push_back(Connect());
  Settle();
  EXPECT_EQ(Ask(""), "") << "the ninth is closed at once";
  idle.pop_back();
  Settle();
  EXPECT_TRUE(Ask("GET / HTTP/1.0\r\n\r\n").starts_with("HTTP/1.0 200"));
}

TEST_F(MetricsEndpointTest, ItsSocketIsForTheGroupAlone) {
  struct stat file {};
  ASSERT_EQ(stat(UnixAddress().path.c_str(), &file), 0);
  EXPECT_EQ(file.st_mode & 0777, 0660u);
  endpoint_.reset();
  EXPECT_NE(stat(UnixAddress().path.c_str(), &file), 0) << "it is removed at the end";
}

TEST_F(MetricsEndpointTest, TcpOfThisHostIsServed) {
  const auto opened =
      MetricsEndpoint::Open(io_, "tcp:127.0.0.1:0", [] { return std::string("page"); });
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  ASSERT_GT((*opened)->address().port, 0);
  asio::ip::tcp::socket socket(io_);
  socket.connect({asio::ip::address_v4::loopback(), (*opened)->address().port});
  asio::write(socket, asio::buffer(std::string("GET /metrics HTTP/1.0\r\n\r\n")));
  std::string answer;
  bool over = false;
  asio::async_read(socket, asio::dynamic_buffer(answer),
                   [&](const boost::system::error_code&, std::size_t) { over = true; });
  EXPECT_TRUE(RunUntil([&] { return over; }));
  EXPECT_TRUE(answer.ends_with("\r\n\r\npage")) << answer;
}

TEST_F(MetricsEndpointTest, AddressesBeyondThisHostAreRefusedWithTheReason) {
  for (const std::string address : {"tcp:0.0.0.0:0", "tcp:[::]:0", "tcp:192.168.1.5:9100",
                                    "tcp:example.org:9100", "tls:127.0.0.1:9100"}) {
    const auto opened = MetricsEndpoint::Open(io_, address, [] { return std::string(); });
    ASSERT_FALSE(opened.ok()) << address;
    EXPECT_EQ(opened.error().kind, ErrorKind::kUsage);
    EXPECT_TRUE(Has(opened.error().message, "use tcp:127.0.0.1:PORT or unix:PATH"))
        << opened.error().message;
  }
}

TEST_F(MetricsEndpointTest, BytesOfTheProtocolAreNoRequest) {
  // A Hello of 4 bytes, as a client begins: whoever reaches this socket cannot open a session.
  EXPECT_TRUE(Has(Ask(std::string("\x06\0\0\0\x0a\x04\x08\x01\x18\x02\r\n\r\n", 14)), " 400 "));
  EXPECT_EQ(pages_, 0);
}

}  // namespace
}  // namespace footing::monitoring
