#include "common/net/device_link.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <sys/stat.h>

#include "common/net/framing.h"
#include "common/net/listener.h"
#include "tests/common/net/io_fixture.h"
#include "tests/common/net/tls_fixture.h"

namespace footing::device_link {
namespace {

/// footingd's side: takes what is sent.
class DeviceLinkTest : public transport::IoFixture {
 protected:
  void Listen() {
    auto listener = transport::Listener::Open(io_, UnixAddress(), [this](transport::Socket socket) {
      transport::FramedHandlers handlers;
      handlers.on_frame = [this](std::string_view payload) {
        v1::DeviceEnvelope message;
        ASSERT_TRUE(message.ParseFromArray(payload.data(), static_cast<int>(payload.size())));
        received_.push_back(message);
      };
      handlers.on_close = [this](const std::string&) { ++closed_; };
      peer_ = std::make_unique<transport::FramedConnection>(
          std::move(socket), transport::FramedLimits(), std::move(handlers));
      peer_->Start();
      ++accepted_;
    });
    ASSERT_TRUE(listener) << listener.error().message;
    listener_ = std::move(listener).value();
  }

  Options Counting() {
    Options options{.to = UnixAddress()};
    options.on_open = [this] { ++opened_; };
    options.on_close = [this] { ++lost_; };
    options.on_message = [this](const v1::DeviceEnvelope& message) {
      messages_.push_back(message);
    };
    return options;
  }

  std::unique_ptr<transport::Listener> listener_;
  std::unique_ptr<transport::FramedConnection> peer_;
  std::vector<v1::DeviceEnvelope> received_, messages_;
  int accepted_ = 0, closed_ = 0, opened_ = 0, lost_ = 0;
};

TEST_F(DeviceLinkTest, DialsUntilSomebodyListensAndAgainAfterALoss) {
  DeviceLink link(io_, Counting());
  link.Start();
  io_.run_for(std::chrono::milliseconds(20));
  EXPECT_FALSE(link.open());
  Listen();
  ASSERT_TRUE(RunUntil([&] { return link.open() && accepted_ == 1; }));
  peer_->Close();
  ASSERT_TRUE(RunUntil([&] { return lost_ == 1; }));
  ASSERT_TRUE(RunUntil([&] { return opened_ == 2 && accepted_ == 2; }));
  link.Stop("done");
  ASSERT_TRUE(RunUntil([&] { return closed_ == 1; }));
  io_.run_for(std::chrono::milliseconds(300));
  EXPECT_EQ(accepted_, 2) << "nobody dials after the end";
  EXPECT_EQ(lost_, 1);
}

TEST_F(DeviceLinkTest, WhatHasNoConnectionIsDroppedAndCounted) {
  DeviceLink link(io_, Counting());
  EXPECT_FALSE(link.Send(stream::HandFrame{}));
  Listen();
  link.Start();
  ASSERT_TRUE(RunUntil([&] { return link.open() && accepted_ == 1; }));
  EXPECT_TRUE(link.Send(stream::HandFrame{}));
  ASSERT_TRUE(RunUntil([&] { return received_.size() == 1; }));
  EXPECT_TRUE(received_.front().has_hand_frame());
  EXPECT_EQ(link.sent(), 1u);
  EXPECT_EQ(link.dropped(), 1u);
}

TEST_F(DeviceLinkTest, PassesOnWhatIsSentButARefusalGoesToTheLog) {
  Listen();
  DeviceLink link(io_, Counting());
  link.Start();
  ASSERT_TRUE(RunUntil([&] { return link.open() && accepted_ == 1; }));
  v1::DeviceEnvelope refused, output;
  refused.mutable_refused()->set_reason("there is one already");
  output.mutable_output()->set_slot(3);
  peer_->Send(refused.SerializeAsString());
  peer_->Send("not an envelope");
  peer_->Send(output.SerializeAsString());
  ASSERT_TRUE(RunUntil([&] { return !messages_.empty(); }));
  ASSERT_EQ(messages_.size(), 1u);
  EXPECT_EQ(messages_.front().output().slot(), 3u);
}

/// A link beyond this host, to a server of its own with a token.
class DeviceSession : public transport::TlsFixture {
 protected:
  DeviceSession() {
    takes_devices_ = true;
    options_.view_token = "look-but-do-not-touch-it";
    UseToken(transport::kFixtureToken);
  }
  ~DeviceSession() override { unsetenv("FOOTING_TOKEN_FILE"); }

  void UseToken(const std::string& token) const {
    const std::string path = config_.Path("token");
    std::ofstream(path) << token;
    EXPECT_EQ(chmod(path.c_str(), 0600), 0);
    setenv("FOOTING_TOKEN_FILE", path.c_str(), 1);
  }

  device_link::Options To(const transport::Address& address) {
    device_link::Options options{.to = address, .client_name = "tracker"};
    options.on_message = [this](const v1::DeviceEnvelope& message) {
      messages_.push_back(message);
    };
    options.on_refused = [this](const v1::DeviceRefused& message) {
      refused_.push_back(message.reason());
    };
    options.on_close = [this] { ++lost_; };
    return options;
  }

  /// Why the server never lets such a link in.
  Error WhyNot(const transport::Address& address) {
    DeviceLink link(io_, To(address));
    link.Start();
    EXPECT_TRUE(RunUntil([&] { return link.NeverOpen().kind == ErrorKind::kFailure; }));
    EXPECT_FALSE(link.was_open());
    return link.NeverOpen();
  }

  static v1::DeviceEnvelope Attach() {
    v1::DeviceEnvelope message;
    message.mutable_attach()->set_slot(3);
    return message;
  }

  std::vector<v1::DeviceEnvelope> messages_;
  std::vector<std::string> refused_;
  int lost_ = 0;
};

TEST_F(DeviceSession, GoesBothWaysOverTlsWithTheToken) {
  StartTlsServer();
  DeviceLink link(io_, To(transport::TlsAddress(Port())));
  EXPECT_EQ(link.NeverOpen().kind, ErrorKind::kNoDevice);
  link.Start();
  ASSERT_TRUE(RunUntil([&] { return link.open(); }));
  EXPECT_TRUE(link.Send(Attach()));
  EXPECT_TRUE(link.Send(stream::HandFrame{}));
  ASSERT_TRUE(RunUntil([&] { return devices_.size() == 2; }));
  const transport::SessionInfo who = devices_[0].first;
  EXPECT_EQ(who.role, v1::ROLE_CONTROL);
  EXPECT_EQ(who.client_name, "tracker");
  EXPECT_EQ(devices_[0].second.attach().slot(), 3u);
  EXPECT_TRUE(devices_[1].second.has_hand_frame());
  v1::DeviceEnvelope output, refused;
  output.mutable_output()->set_slot(3);
  refused.mutable_refused()->set_reason("there is one already");
  server_->SendDevice(who.session, output);
  server_->SendDevice(who.session, refused);
  server_->SendDevice(who.session + 1, output);  // Nobody.
  ASSERT_TRUE(RunUntil([&] { return !refused_.empty(); }));
  ASSERT_EQ(messages_.size(), 1u);
  EXPECT_EQ(messages_[0].output().slot(), 3u);
  server_->EndSession(who.session, "it says what makes no sense");
  ASSERT_TRUE(RunUntil([&] { return lost_ == 1; }));
  ASSERT_TRUE(RunUntil([&] { return link.open(); })) << "it comes again";
  link.Stop("done");
  ASSERT_TRUE(RunUntil([&] { return ended_.size() == 2; }));
  EXPECT_EQ(lost_, 1) << "its own end does not count as a loss";
}

TEST_F(DeviceSession, WithoutTheRightTokenItIsRefusedAsAnyClient) {
  options_.wrong_token_wait_s = 0.01;
  StartTlsServer();
  UseToken("0123456789abcdeX");
  EXPECT_NE(WhyNot(transport::TlsAddress(Port())).message.find("the token is wrong"),
            std::string::npos);
  UseToken("look-but-do-not-touch-it");
  EXPECT_NE(WhyNot(transport::TlsAddress(Port()))
                .message.find("came with the token of the "
                              "server's view_token_file"),
            std::string::npos);
  unsetenv("FOOTING_TOKEN_FILE");
  EXPECT_NE(WhyNot(transport::TlsAddress(Port())).message.find("this server wants its token"),
            std::string::npos);
  EXPECT_TRUE(devices_.empty());
}

TEST_F(DeviceSession, InClearToAPortOfTlsItHearsWhatToDo) {
  StartTlsServer();
  transport::Address address = transport::TlsAddress(Port());
  address.kind = transport::Address::Kind::kTcp;
  DeviceLink link(io_, To(address));
  link.Start();
  ASSERT_TRUE(RunUntil([&] { return link.open(); }));
  EXPECT_TRUE(link.Send(Attach()));
  ASSERT_TRUE(RunUntil([&] { return link.NeverOpen().kind == ErrorKind::kFailure; }));
  EXPECT_NE(link.NeverOpen().message.find("connect with tls:HOST:PORT"), std::string::npos);
  EXPECT_FALSE(link.was_open());
}

TEST_F(DeviceSession, AServerWithoutASourceForThemSaysSo) {
  takes_devices_ = false;
  StartTlsServer();
  EXPECT_NE(WhyNot(transport::TlsAddress(Port())).message.find("takes no devices of other hosts"),
            std::string::npos);
}

}  // namespace
}  // namespace footing::device_link
