#include "common/net/framed_connection.h"

#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/write.hpp>
#include <optional>
#include <vector>

#include "common/net/framing.h"
#include "tests/common/net/io_fixture.h"

namespace footing::transport {
namespace {

namespace asio = boost::asio;
using Raw = asio::local::stream_protocol::socket;

class FramedConnectionTest : public IoFixture {
 protected:
  /// A connection under test, and the raw other end of it.
  void Connect(const FramedLimits& limits = {}) {
    Raw near(io_);
    asio::local::connect_pair(near, far_);
    far_.non_blocking(true);
    FramedHandlers handlers;
    handlers.on_frame = [this](std::string_view payload) { frames_.emplace_back(payload); };
    handlers.on_close = [this](const std::string& reason) { closed_ = reason; };
    connection_.emplace(Socket(std::move(near)), limits, std::move(handlers));
    connection_->Start();
  }
  void WriteRaw(const std::string& bytes) { asio::write(far_, asio::buffer(bytes)); }
  /// Everything that can be read now, appended.
  void ReadRaw() {
    boost::system::error_code error;
    std::string piece(1 << 16, '\0');
    while (!error) {
      const std::size_t size = far_.read_some(asio::buffer(piece), error);
      received_.append(piece, 0, size);
    }
    if (error == asio::error::eof) end_seen_ = true;
  }

  Raw far_{io_};
  std::optional<FramedConnection> connection_;
  std::vector<std::string> frames_;
  std::optional<std::string> closed_;
  std::string received_;
  bool end_seen_ = false;
};

TEST_F(FramedConnectionTest, FramesPassBothWays) {
  Connect();
  WriteRaw(Frame("in 1") + Frame("in 2"));
  EXPECT_TRUE(connection_->Send("out"));
  EXPECT_TRUE(RunUntil([&] { return frames_.size() == 2; }));
  ReadRaw();
  EXPECT_EQ(frames_, (std::vector<std::string>{"in 1", "in 2"}));
  EXPECT_EQ(received_, Frame("out"));
}

TEST_F(FramedConnectionTest, AnOversizedLengthEndsTheConnectionWithBothNumbers) {
  Connect();
  WriteRaw(std::string("\x00\x00\x00\x10", 4));  // 256 MiB.
  ASSERT_TRUE(RunUntil([&] { return closed_.has_value(); }));
  EXPECT_NE(closed_->find("268435456"), std::string::npos);
  EXPECT_NE(closed_->find("65536"), std::string::npos);
}

TEST_F(FramedConnectionTest, ATruncatedFrameIsToldFromACleanEnd) {
  Connect();
  WriteRaw("\x05");
  far_.close();
  ASSERT_TRUE(RunUntil([&] { return closed_.has_value(); }));
  EXPECT_EQ(*closed_, "the other side closed in the middle of a message");
  Raw fresh(io_);
  far_ = std::move(fresh);
  closed_.reset();
  Connect();
  far_.close();
  ASSERT_TRUE(RunUntil([&] { return closed_.has_value(); }));
  EXPECT_EQ(*closed_, "the other side closed the connection");
}

TEST_F(FramedConnectionTest, AFullQueueRefusesWithoutLosingWhatWaits) {
  FramedLimits limits;
  limits.max_queued_bytes = 100'000;
  Connect(limits);
  const std::string payload(10'000, 'p');
  std::size_t taken = 0;
  while (connection_->Send(payload)) ++taken;  // First the kernel's buffer fills, then the queue.
  EXPECT_LE(connection_->queued_bytes(), limits.max_queued_bytes);
  EXPECT_GT(connection_->queued_bytes(), limits.max_queued_bytes - payload.size());
  const std::size_t expected = taken * (payload.size() + kLengthBytes);
  EXPECT_TRUE(RunUntil([&] {
    ReadRaw();
    return received_.size() >= expected;
  }));
  EXPECT_EQ(received_.size(), expected);
  EXPECT_FALSE(closed_.has_value());
}

TEST_F(FramedConnectionTest, AFrameOverTheOutwardLimitIsRefused) {
  FramedLimits limits;
  limits.max_out_bytes = 10;
  Connect(limits);
  EXPECT_TRUE(connection_->Send(std::string(10, 'x')));
  EXPECT_FALSE(connection_->Send(std::string(11, 'x')));
}

TEST_F(FramedConnectionTest, TheLastWordArrivesThoughTheOtherSideStillTalks) {
  Connect();
  WriteRaw(Frame("talk") + "more that nobody reads");
  connection_->Finish("last", "told to go");
  EXPECT_TRUE(RunUntil([&] {
    ReadRaw();
    return end_seen_;
  }));
  EXPECT_EQ(received_, Frame("last"));
  far_.close();
  ASSERT_TRUE(RunUntil([&] { return closed_.has_value(); }));
  EXPECT_EQ(*closed_, "told to go");
  EXPECT_TRUE(frames_.empty());
}

TEST_F(FramedConnectionTest, AnOtherSideThatNeverReadsDelaysTheEndByTheLingerOnly) {
  FramedLimits limits;
  limits.linger_s = 0.01;
  Connect(limits);
  while (connection_->Send(std::string(10'000, 'p'))) {
  }
  connection_->Finish("last", "too slow");
  ASSERT_TRUE(RunUntil([&] { return closed_.has_value(); }));
  EXPECT_EQ(*closed_, "too slow");
}

TEST_F(FramedConnectionTest, AfterCloseNoHandlerIsCalled) {
  Connect();
  WriteRaw(Frame("late"));
  connection_->Close();
  Settle();
  EXPECT_TRUE(frames_.empty());
  EXPECT_FALSE(closed_.has_value());
}

}  // namespace
}  // namespace footing::transport
